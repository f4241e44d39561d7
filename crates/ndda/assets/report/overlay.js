// What lies over the blocks: axes with north, a scale bar, and the picture that a reader saves.
"use strict";

const AXES = [["x", "#cd3e36", [1, 0, 0]], ["y (N)", "#2c9254", [0, 1, 0]], ["z", "#3876c8", [0, 0, 1]]];

class Overlay {
  constructor(viewer, box) {
    this.viewer = viewer;
    this.box = box;
    this.canvas = document.createElement("canvas");
    this.canvas.className = "overlay";
    box.append(this.canvas);
    viewer.drawn = () => this.draw();
    this.draw();
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.box;
    const ratio = this.viewer.renderer.getPixelRatio();
    [this.canvas.width, this.canvas.height] = [width * ratio, height * ratio];
    const ctx = this.canvas.getContext("2d");
    ctx.scale(ratio, ratio);
    this.drawAxes(ctx, 48, 52);
    this.drawScaleBar(ctx, width - 16, height - 20, 0.22 * width);
  }

  /** The directions of x (east), y (north) and z, the farthest away first. */
  drawAxes(ctx, x, y) {
    const turn = this.viewer.camera.matrixWorld.elements;
    const along = (direction, row) => direction.reduce((sum, d, i) => sum + d * turn[4 * row + i], 0);
    const arrows = AXES.map(([name, colour, direction]) =>
      ({ name, colour, right: along(direction, 0), up: along(direction, 1), near: along(direction, 2) }));
    ctx.font = "13px system-ui, sans-serif";
    ctx.textBaseline = "middle";
    for (const { name, colour, right, up } of arrows.sort((a, b) => a.near - b.near)) {
      const [dx, dy, length] = [30 * right, -30 * up, Math.hypot(right, up)];
      Object.assign(ctx, { strokeStyle: colour, fillStyle: colour, lineWidth: 2.2 });
      ctx.beginPath();
      ctx.moveTo(x, y);
      ctx.lineTo(x + dx, y + dy);
      ctx.stroke();
      ctx.beginPath();
      if (length < 0.2) {
        // An axis along the line of sight is a dot.
        ctx.arc(x + dx, y + dy, 3.4, 0, 7);
      } else {
        const [ex, ey] = [right / length, -up / length];
        ctx.moveTo(x + dx + 7 * ex, y + dy + 7 * ey);
        ctx.lineTo(x + dx - 2 * ex - 3.8 * ey, y + dy - 2 * ey + 3.8 * ex);
        ctx.lineTo(x + dx - 2 * ex + 3.8 * ey, y + dy - 2 * ey - 3.8 * ex);
      }
      ctx.fill();
      ctx.fillStyle = this.colour();
      const aside = length < 0.2 ? [-14, 12] : [(12 * right) / length, (-17 * up) / length];
      ctx.textAlign = aside[0] > 5 ? "left" : aside[0] < -5 ? "right" : "center";
      ctx.fillText(name, x + dx + aside[0], y + dy + aside[1]);
    }
  }

  /** A bar of a round length, as long as it says at the middle of the view. */
  drawScaleBar(ctx, right, y, most) {
    const perMetre = this.viewer.pixelsPerMetre();
    const length = roundBelow(most / perMetre);
    const left = right - length * perMetre;
    Object.assign(ctx, { strokeStyle: this.colour(), fillStyle: this.colour(), lineWidth: 2 });
    ctx.beginPath();
    for (const [from, to] of [[[left, y], [right, y]], [[left, y - 5], [left, y + 5]], [[right, y - 5], [right, y + 5]]]) {
      ctx.moveTo(...from);
      ctx.lineTo(...to);
    }
    ctx.stroke();
    ctx.font = "13px system-ui, sans-serif";
    Object.assign(ctx, { textAlign: "center", textBaseline: "alphabetic" });
    ctx.fillText(withUnit(length, "m"), (left + right) / 2, y - 9);
  }

  colour() {
    return getComputedStyle(document.body).getPropertyValue("--text");
  }

  /** The blocks as they are seen now, below a title, as a PNG file for the reader. */
  save(title, below, bars) {
    const ratio = this.viewer.renderer.getPixelRatio();
    const [width, height, strip] = [this.box.clientWidth, this.box.clientHeight, 52];
    const sheet = document.createElement("canvas");
    [sheet.width, sheet.height] = [width * ratio, (height + strip) * ratio];
    const ctx = sheet.getContext("2d");
    ctx.scale(ratio, ratio);
    ctx.fillStyle = getComputedStyle(document.body).getPropertyValue("--card");
    ctx.fillRect(0, 0, width, height + strip);
    ctx.fillStyle = this.colour();
    ctx.textBaseline = "middle";
    ctx.font = "600 16px system-ui, sans-serif";
    ctx.fillText(title, 16, 18, width - 32);
    ctx.font = "13px system-ui, sans-serif";
    ctx.fillText(below, 16, 39, width - 32);
    ctx.drawImage(this.viewer.renderer.domElement, 0, strip, width, height);
    ctx.drawImage(this.canvas, 0, strip, width, height);
    bars.forEach((bar, i) => this.drawColours(ctx, 16, height + strip - 16 - 58 * i, bar));
    const link = document.createElement("a");
    link.download = `${title.replace(/[^\p{L}\p{N}]+/gu, "_").slice(0, 60) || "blocks"}.png`;
    link.href = sheet.toDataURL("image/png");
    link.click();
  }

  drawColours(ctx, left, bottom, choice) {
    const { colours, words } = choice;
    const scale = ctx.createLinearGradient(left, 0, left + 200, 0);
    const count = words ? colours.length : colours.length - 1;
    colours.forEach((hex, i) => {
      scale.addColorStop(i / count, `#${hex}`);
      // Colours of states do not run into each other.
      if (words) scale.addColorStop((i + 1) / count, `#${hex}`);
    });
    ctx.fillStyle = scale;
    ctx.fillRect(left, bottom - 26, 200, 10);
    Object.assign(ctx, { fillStyle: this.colour(), textBaseline: "alphabetic", textAlign: "left" });
    ctx.fillText(choice.label, left, bottom - 33);
    const [low, high] = words ? [words[0], words.at(-1)] : scaleEnds(choice);
    ctx.fillText(low, left, bottom);
    ctx.textAlign = "right";
    ctx.fillText(high, left + 200, bottom);
  }
}

/** The largest of 1, 2 and 5 times a power of ten that is not above a length. */
function roundBelow(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * [5, 2, 1].find((digit) => digit * power <= length * (1 + 1e-9));
}
