// Ties the page together: slider, colours, curves.
"use strict";

(async () => {
  const byId = (id) => document.getElementById(id);
  const data = JSON.parse(byId("data").textContent);
  let jumpTo = () => {};
  const charts = new Charts(data.charts, (time) => jumpTo(time));
  if (data.motion) {
    try {
      const player = await showBlocks(byId, data, charts);
      jumpTo = (time) => player.jumpTo(time);
    } catch (error) {
      const note = document.createElement("p");
      note.className = "note";
      note.textContent = `The blocks cannot be shown: this browser has no WebGL or is older than 2023 (${error.message}).`;
      byId("view").replaceChildren(note);
    }
  }
  document.documentElement.dataset.ready = "yes";
})();

async function showBlocks(byId, data, charts) {
  const motion = new Motion(data.motion, await inflated(byId("numbers").textContent));
  const viewer = new Viewer(byId("view"), motion);
  const choices = colourChoices(motion);
  byId("colour").append(...choices.map((choice, i) => new Option(choice.label, i)));
  byId("colour").value = 0;
  const player = new Player(byId, motion.about.times_s, (frame) => {
    const choice = choices[byId("colour").value];
    viewer.show(frame, choice, Number(byId("factor").value), byId("rest").value);
    charts.setTime(motion.about.times_s[frame]);
  });
  const recolour = () => {
    showBar(byId, choices[byId("colour").value]);
    player.show();
  };
  for (const id of ["colour", "factor", "rest"]) byId(id).addEventListener("change", recolour);
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => viewer.look(button.dataset.view));
  }
  for (const button of document.querySelectorAll("[data-time]")) {
    button.addEventListener("click", () => player.jumpTo(Number(button.dataset.time)));
  }
  byId("view").addEventListener("pointermove", (event) => {
    if (event.buttons !== 0) return;
    const block = viewer.blockAt(event.clientX, event.clientY);
    byId("picked").textContent = block === null ? "" : data.block_names[block] || `block ${block}`;
  });
  recolour();
  if (viewer.hidesMotion()) {
    byId("rest").value = "glass";
    recolour();
  }
  return player;
}

/** The bar of colours beside the blocks, its range the same for all frames. */
function showBar(byId, choice) {
  byId("bar").hidden = !choice.values;
  if (!choice.values) return;
  const { least, bottom = least, top, largest } = choice.range;
  const stops = VIRIDIS.map((hex) => `#${hex}`);
  byId("bar-title").textContent = choice.label;
  byId("bar-colours").style.background = `linear-gradient(to right, ${stops})`;
  const numbers = [withUnit(bottom, choice.unit), (top < largest ? "≥ " : "") + withUnit(top, choice.unit)];
  byId("bar-numbers").replaceChildren(...numbers.map((text) => {
    const number = document.createElement("span");
    number.textContent = text;
    return number;
  }));
  byId("bar-numbers").title = top < largest ? `largest: ${withUnit(largest, choice.unit)}` : "";
}

/** Slider, play and keys. */
class Player {
  constructor(byId, times, showFrame) {
    this.times = times;
    this.showFrame = showFrame;
    this.slider = byId("slider");
    this.button = byId("play");
    this.label = byId("time");
    this.slider.addEventListener("input", () => this.show());
    this.button.addEventListener("click", () => this.toggle());
    byId("view").addEventListener("keydown", (event) => this.key(event));
  }

  get frame() {
    return Number(this.slider.value);
  }

  show() {
    const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(this.times.at(-1) || 1))));
    this.label.textContent = `t = ${this.times[this.frame].toFixed(digits)} s`;
    this.showFrame(this.frame);
  }

  go(frame) {
    this.slider.value = Math.min(Math.max(frame, 0), this.times.length - 1);
    this.show();
  }

  jumpTo(time) {
    const distance = (frame) => Math.abs(this.times[frame] - time);
    this.go(this.times.map((_, i) => i).reduce((best, i) => (distance(i) < distance(best) ? i : best), 0));
  }

  toggle() {
    if (this.playing) {
      clearInterval(this.playing);
      this.playing = null;
    } else {
      if (this.frame === this.times.length - 1) this.go(0);
      // The whole run in some six seconds, however many frames it has.
      const wait = Math.min(Math.max(6000 / this.times.length, 40), 250);
      this.playing = setInterval(() => this.step(), wait);
    }
    this.button.textContent = this.playing ? "❚❚" : "▶";
    this.button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  step() {
    if (this.frame === this.times.length - 1) this.toggle();
    else this.go(this.frame + 1);
  }

  key(event) {
    const moves = { ArrowLeft: -1, ArrowRight: 1 };
    if (event.key === " ") this.toggle();
    else if (event.key in moves) this.go(this.frame + moves[event.key]);
    else return;
    event.preventDefault();
  }
}
