// Bolts in 3D: bars that blocks do not hide, coloured by what they carry.
"use strict";

const FORCE_COLOURS = ["fff6be", "fecb5c", "fc8d3c", "de2d26", "7a0026"];
const FORCE_BYTES = FORCE_COLOURS.map(bytesOf);
const STATE_NAMES = ["elastic", "debonded", "yielding", "broken"];
const STATE_COLOURS = ["56b4e9", "f0d23c", "de5014", "78006e"];
const STATE_BYTES = STATE_COLOURS.map(bytesOf);
/** Numbers of a piece: its ends, their displacements, tension, utilisation, state, bolt. */
const PIECE = 16;
/** Radius of a bar over the diagonal of what is looked at. */
const BAR_RADIUS = 0.0016;
/** Two triangles for each of the four sides of a bar, by its corners: 0 to 3 around one end, 4 to 7 around the other. */
const SIDES = [0, 1, 2, 3].flatMap((k) => {
  const next = (k + 1) % 4;
  return [k, next, 4 + k, next, 4 + next, 4 + k];
});

class Bolts {
  constructor(motion, numbers, diagonal) {
    this.about = motion.about.bolts;
    this.numbers = numbers;
    this.radius = BAR_RADIUS * diagonal;
    this.first = [0];
    for (const count of this.about.counts) this.first.push(this.first.at(-1) + count);
    const size = 3 * SIDES.length * Math.max(...this.about.counts);
    const bars = new THREE.BufferGeometry();
    this.corners = new THREE.BufferAttribute(new Float32Array(size), 3);
    this.colours = new THREE.BufferAttribute(new Float32Array(size), 3);
    bars.setAttribute("position", this.corners);
    bars.setAttribute("color", this.colours);
    this.mesh = new THREE.Mesh(bars, new THREE.MeshLambertMaterial(
      { vertexColors: true, flatShading: true, depthTest: false, transparent: true }));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
  }

  /** What the colours of a way to look at bolts mean. */
  scale(way) {
    const [low, high] = this.about.force_n;
    if (way === "force") return { label: "tension of bolts", unit: "N", range: { least: low, top: high, largest: high } };
    if (way === "yield") {
      const most = 100 * this.about.utilisation;
      return { label: "tension of bolts over yield", unit: "%", range: { least: 0, top: most, largest: most } };
    }
    return null;
  }

  colour(piece, way) {
    const [force, share, state] = this.numbers.subarray(PIECE * piece + 12, PIECE * piece + 15);
    if (way === "state") return STATE_BYTES[state];
    const { least, top } = this.scale(way).range;
    const value = way === "force" ? force : 100 * share;
    return between(FORCE_BYTES, top > least ? (value - least) / (top - least) : 0);
  }

  /** Puts the bolts where they are in a frame, displacements times `factor`. */
  show(frame, factor, way) {
    this.mesh.visible = way !== "hidden";
    if (!this.mesh.visible) return;
    const [from, to] = [this.first[frame], this.first[frame + 1]];
    for (let piece = from; piece < to; piece += 1) {
      const n = this.numbers.subarray(PIECE * piece, PIECE * piece + 12);
      const end = (k) => new THREE.Vector3(...[0, 1, 2].map((i) => n[3 * k + i] + (factor - 1) * n[6 + 3 * k + i]));
      this.bar(piece - from, end(0), end(1), this.colour(piece, way));
    }
    this.mesh.geometry.setDrawRange(0, SIDES.length * (to - from));
    this.corners.needsUpdate = true;
    this.colours.needsUpdate = true;
  }

  bar(place, a, b, colour) {
    const along = b.clone().sub(a).normalize();
    const across = Math.abs(along.z) < 0.9 ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0);
    const u = along.clone().cross(across).normalize().multiplyScalar(this.radius);
    const v = along.clone().cross(u);
    const around = [u, v, u.clone().negate(), v.clone().negate()];
    const corners = [a, b].flatMap((end) => around.map((offset) => end.clone().add(offset)));
    SIDES.forEach((corner, i) => {
      const at = 3 * (SIDES.length * place + i);
      corners[corner].toArray(this.corners.array, at);
      putColour(this.colours.array, at, colour);
    });
  }
}
