// Colours of blocks: one per block, or by a field on the scale of viridis.
"use strict";

// Matplotlib's viridis at even places, without its darkest ninth, where edges would not be seen.
const VIRIDIS = ["482878", "3e4a89", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"];
const STILL_COLOUR = [226, 223, 217];

const bytesOf = (hex) => [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16));
const VIRIDIS_BYTES = VIRIDIS.map(bytesOf);

/** Colour of a part from 0 to 1 on a scale of colours at even places. */
function between(scale, part) {
  const place = Math.min(Math.max(part, 0), 1) * (scale.length - 1);
  const low = Math.min(Math.floor(place), scale.length - 2);
  return scale[low].map((c, i) => c + (place - low) * (scale[low + 1][i] - c));
}

const viridis = (part) => between(VIRIDIS_BYTES, part);

/** A muted colour per block; neighbours in number are far apart in hue. */
function blockColour(block) {
  const hue = (200 + block * 137.508) % 360;
  const [saturation, lightness] = [0.38, 0.52 + 0.1 * ((block * 7) % 3 - 1)];
  const a = saturation * Math.min(lightness, 1 - lightness);
  return [0, 8, 4].map((n) => {
    const k = (n + hue / 30) % 12;
    return 255 * (lightness - a * Math.max(-1, Math.min(k - 3, 9 - k, 1)));
  });
}

// The renderer works with linear light.
const LINEAR = Float32Array.from({ length: 256 }, (_, i) => {
  const c = i / 255;
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
});

/** Writes a colour of bytes as linear light. */
function putColour(target, at, colour) {
  for (let i = 0; i < 3; i += 1) {
    target[at + i] = LINEAR[Math.round(colour[i])];
  }
}

/** A number and its unit, with the prefix that makes it short. */
function withUnit(value, unit) {
  const scaled = { Pa: [[1e9, "GPa"], [1e6, "MPa"], [1e3, "kPa"]], m: [[1, "m"], [1e-3, "mm"], [1e-6, "µm"]],
    J: [[1e6, "MJ"], [1e3, "kJ"]], N: [[1e6, "MN"], [1e3, "kN"]] }[unit] || [];
  const fitting = scaled.find(([size]) => Math.abs(value) >= size);
  const [size, name] = value === 0 ? [1, unit] : fitting || [1, unit];
  const number = value / size;
  const short = number !== 0 && (Math.abs(number) < 1e-2 || Math.abs(number) >= 1e4);
  return `${short ? number.toExponential(1) : Number(number.toPrecision(3))} ${name}`.trim();
}

/** The choices: what blocks can be coloured by. */
function colourChoices(motion) {
  const distances = (frame) => {
    const moved = motion.displacements(frame);
    return Float32Array.from({ length: moved.length / 3 }, (_, i) => Math.hypot(...moved.subarray(3 * i, 3 * i + 3)));
  };
  const displacement = { label: "displacement", unit: "m", of_nodes: true,
    range: { least: 0, largest: motion.about.moved.top, top: motion.about.moved.top }, values: distances };
  const fields = motion.fields.map((field) => ({ ...field, values: (frame) => motion.values(field, frame) }));
  // What begins near nothing begins at nothing.
  for (const { range } of fields) {
    if (range.least > 0 && range.least < 0.2 * range.top) range.bottom = 0;
  }
  return [{ label: "block" }, displacement, ...fields];
}
