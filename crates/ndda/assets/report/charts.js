// Curves over time, with a line at the moment that the blocks show.
"use strict";

const CURVE_COLOURS = ["#3b7dd8", "#d9822b", "#2f9e63", "#b6508f", "#7a6cc4", "#8c8c3b"];

class Charts {
  constructor(data, pickTime) {
    this.data = data;
    this.pickTime = pickTime;
    this.time = 0;
    this.boxes = [...document.querySelectorAll("#charts .plot")];
    this.build();
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.build());
    new ResizeObserver(() => this.resize()).observe(document.body);
  }

  build() {
    this.boxes.forEach((box) => box.replaceChildren());
    this.plots = this.data.charts.map((chart, i) => {
      const curves = chart.curves.map((curve) => curve.values);
      const plot = new uPlot(this.options(chart, this.boxes[i]), [chart.time_s || this.data.time_s, ...curves], this.boxes[i]);
      plot.over.addEventListener("click", () => this.pickTime(plot.posToVal(plot.cursor.left, "x")));
      return plot;
    });
  }

  options(chart, box) {
    const style = getComputedStyle(document.body);
    const axis = { stroke: style.getPropertyValue("--faint"), font: "12px system-ui",
      grid: { stroke: style.getPropertyValue("--line"), width: 1 }, ticks: { stroke: style.getPropertyValue("--line") } };
    const short = (value) => (value === null || value === undefined ? "–" : Number(value.toPrecision(4)).toString());
    const tick = (plot, values) => values.map((v) => (v === null ? null : Number(v.toPrecision(6)).toString()));
    const isPower = (v) => Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-6;
    const powers = (plot, values) => values.map((v) => (v !== null && isPower(v) ? v.toExponential(0) : null));
    const onlyPowers = (plot, splits) => splits.map((v) => (isPower(v) ? v : null));
    const filter = chart.is_log ? { filter: onlyPowers } : {};
    const series = chart.curves.map((curve, i) => ({ label: curve.label, width: 1.6, points: { show: false },
      stroke: CURVE_COLOURS[i % CURVE_COLOURS.length], value: (plot, value) => short(value) }));
    return {
      width: box.clientWidth, height: 220,
      scales: { x: { time: false }, y: chart.is_log ? { distr: 3 } : {} },
      axes: [{ ...axis, values: (plot, values) => values.map((v) => `${v} s`) },
        { ...axis, grid: { ...axis.grid, ...filter }, ticks: { ...axis.ticks, ...filter }, size: 72, label: chart.unit, labelSize: chart.unit ? 18 : 0, labelFont: "12px system-ui",
          values: chart.is_log ? powers : tick }],
      series: [{ label: "t", value: (plot, value) => (value === null ? "–" : `${short(value)} s`) }, ...series],
      legend: { live: true }, cursor: { drag: { x: true, y: false }, sync: { key: "time" } },
      hooks: { draw: [(plot) => this.mark(plot, style.getPropertyValue("--accent"))] },
    };
  }

  /** The line at the moment shown. */
  mark(plot, colour) {
    const x = plot.valToPos(this.time, "x", true);
    const { left, top, width, height } = plot.bbox;
    if (!(x >= left && x <= left + width)) return;
    const { ctx } = plot;
    ctx.save();
    ctx.strokeStyle = colour;
    ctx.lineWidth = window.devicePixelRatio;
    ctx.setLineDash([4, 3]);
    ctx.beginPath();
    ctx.moveTo(x, top);
    ctx.lineTo(x, top + height);
    ctx.stroke();
    ctx.restore();
  }

  setTime(time) {
    this.time = time;
    this.plots.forEach((plot) => plot.redraw(false));
  }

  resize() {
    this.plots.forEach((plot, i) => {
      const { clientWidth: width } = this.boxes[i];
      if (width > 0 && width !== plot.width) plot.setSize({ width, height: 220 });
    });
  }
}
