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

/** More ways than these are not drawn unless asked for. */
const MOST_PATHS = 200;

/** A block's name, and how far its farthest node is from where it began. */
function pickedText(motion, frame, block, names) {
  const moved = motion.displacements(frame);
  let farthest = 0;
  motion.triangles.forEach((node, c) => {
    if (motion.blocks[Math.floor(c / 3)] === block) {
      farthest = Math.max(farthest, Math.hypot(...moved.subarray(3 * node, 3 * node + 3)));
    }
  });
  return `${names[block] || `block ${block}`}: ${withUnit(farthest, "m")}`;
}

async function showBlocks(byId, data, charts) {
  const motion = new Motion(data.motion, await inflated(byId("numbers").textContent));
  const viewer = new Viewer(byId("view"), motion);
  const overlay = new Overlay(viewer, byId("view"));
  const choices = colourChoices(motion);
  byId("colour").append(...choices.map((choice, i) => new Option(choice.label, i)));
  // What moved is what a reader looks for first.
  byId("colour").value = motion.about.moved.top > 0 ? 1 : 0;
  byId("paths").checked = viewer.tracks.count <= MOST_PATHS;
  const bolts = () => (viewer.bolts ? byId("bolts").value : "hidden");
  const player = new Player(byId, motion.about.times_s, (frame) => {
    const choice = choices[byId("colour").value];
    viewer.show(frame, choice, Number(byId("factor").value), { rest: byId("rest").value, paths: byId("paths").checked, bolts: bolts() });
    charts.setTime(motion.about.times_s[frame]);
  });
  const recolour = () => {
    const choice = choices[byId("colour").value];
    showBar(byId, "bar", choice.values ? { ...choice, colours: VIRIDIS } : null);
    if (viewer.bolts) showBar(byId, "bolt-bar", boltBar(viewer, bolts()));
    player.show();
  };
  const tools = ["colour", "factor", "rest", "paths", ...(viewer.bolts ? ["bolts"] : [])];
  for (const id of tools) byId(id).addEventListener("change", recolour);
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => viewer.look(button.dataset.view));
  }
  byId("whole").addEventListener("change", () => {
    viewer.showsWhole = byId("whole").checked;
    viewer.look(viewer.view || "iso");
  });
  byId("save").addEventListener("click", () => {
    const factor = Number(byId("factor").value);
    const below = byId("time").textContent + (factor === 1 ? "" : `, displacements × ${factor}`);
    const choice = choices[byId("colour").value];
    const bars = [choice.values ? { ...choice, colours: VIRIDIS } : null, viewer.bolts ? boltBar(viewer, bolts()) : null];
    overlay.save(data.title, below, bars.filter(Boolean));
  });
  for (const button of document.querySelectorAll("[data-time]")) {
    button.addEventListener("click", () => player.jumpTo(Number(button.dataset.time)));
  }
  byId("view").addEventListener("pointermove", (event) => {
    if (event.buttons !== 0) return;
    const block = viewer.blockAt(event.clientX, event.clientY);
    byId("picked").textContent = block === null ? "" : pickedText(motion, player.frame, block, data.block_names);
  });
  byId("slider").value = motion.frames - 1;
  recolour();
  if (viewer.hidesMotion()) {
    byId("rest").value = "glass";
    recolour();
  }
  return player;
}

/** A bar of colours beside the blocks, its range the same for all frames; none for no choice. */
function showBar(byId, id, choice) {
  byId(id).hidden = !choice;
  if (!choice) return;
  const stops = choice.colours.map((hex) => `#${hex}`);
  byId(`${id}-title`).textContent = choice.label;
  byId(`${id}-colours`).style.background = `linear-gradient(to right, ${choice.words ? steps(stops) : stops})`;
  byId(`${id}-numbers`).replaceChildren(...(choice.words || scaleEnds(choice)).map((text) => {
    const number = document.createElement("span");
    number.textContent = text;
    return number;
  }));
  const { top, largest } = choice.range || {};
  byId(`${id}-numbers`).title = top < largest ? `largest: ${withUnit(largest, choice.unit)}` : "";
}

/** Stops of colours that do not run into each other. */
function steps(stops) {
  const at = (i) => `${(100 * i) / stops.length}%`;
  return stops.flatMap((stop, i) => [`${stop} ${at(i)}`, `${stop} ${at(i + 1)}`]);
}

/** What the bar of the bolts shows. */
function boltBar(viewer, way) {
  if (way === "hidden") return null;
  if (way === "state") return { label: "state of bolts", colours: STATE_COLOURS, words: STATE_NAMES };
  return { ...viewer.bolts.scale(way), colours: FORCE_COLOURS };
}

/** Least and largest value of a scale of colours, in words. */
function scaleEnds(choice) {
  const { least, bottom = least, top, largest } = choice.range;
  return [withUnit(bottom, choice.unit), (top < largest ? "≥ " : "") + withUnit(top, choice.unit)];
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
