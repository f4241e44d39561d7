// The blocks in 3D: triangles and edges that follow the frames, a camera that turns about them.
"use strict";

const VIEWS = { iso: [0.55, -1, 0.7], front: [0, -1, 0.001], side: [1, 0, 0.001], top: [0, -0.001, 1] };

const LENS_DEG = 6;
/** Around the blocks that move, this part of their largest side is shown. */
const SURROUNDINGS = 0.35;

class Viewer {
  constructor(box, motion) {
    this.box = box;
    this.motion = motion;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    box.prepend(this.renderer.domElement);
    this.scene = new THREE.Scene();
    // From far away through a long lens: lengths hardly depend on how near they are, and one scale bar does.
    this.camera = new THREE.PerspectiveCamera(LENS_DEG, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.addLight();
    this.addBlocks();
    this.addPaths();
    this.addBolts();
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());
    // A camera that somebody has moved stays where it is when the window changes.
    this.controls.addEventListener("start", () => { this.view = null; });
    new ResizeObserver(() => this.resize()).observe(box);
    this.resize();
    this.look("iso");
  }

  addLight() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xc9c3b9, 2.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.1);
    sun.position.set(-0.5, 0.6, 1.2);
    // The sun comes from over the left shoulder, wherever one looks from.
    this.camera.add(sun);
    this.scene.add(this.camera);
  }

  addBlocks() {
    const { motion } = this;
    this.positions = new Float32Array(motion.start.length);
    this.corners = new THREE.BufferAttribute(new Float32Array(3 * motion.triangles.length), 3);
    this.colours = new THREE.BufferAttribute(new Float32Array(3 * motion.triangles.length), 3);
    const faces = new THREE.BufferGeometry();
    faces.setAttribute("position", this.corners);
    faces.setAttribute("color", this.colours);
    const rock = { vertexColors: true, flatShading: true, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    const moving = new THREE.MeshLambertMaterial(rock);
    this.resting = new THREE.MeshLambertMaterial({ ...rock, opacity: 0.15 });
    this.faces = new THREE.Mesh(faces, [moving, this.resting]);
    this.groupByRest(faces);
    const edges = new THREE.BufferGeometry();
    this.nodes = new THREE.BufferAttribute(this.positions, 3);
    edges.setAttribute("position", this.nodes);
    edges.setIndex(new THREE.BufferAttribute(motion.edges, 1));
    this.edges = new THREE.LineSegments(edges, new THREE.LineBasicMaterial(
      { color: 0x1c1a17, transparent: true, opacity: 0.55 }));
    // Both move: what they were bounded by at first says nothing.
    this.faces.frustumCulled = false;
    this.edges.frustumCulled = false;
    this.scene.add(this.faces, this.edges);
  }

  /** The ways of the centres of blocks that move, a piece for each frame; blocks do not hide them. */
  addPaths() {
    const { frames } = this.motion;
    this.tracks = this.motion.tracks();
    this.pathEnds = new THREE.BufferAttribute(new Float32Array(6 * this.tracks.count * Math.max(frames - 1, 0)), 3);
    const paths = new THREE.BufferGeometry();
    paths.setAttribute("position", this.pathEnds);
    this.paths = new THREE.LineSegments(paths, new THREE.LineBasicMaterial(
      { color: 0xb3261e, transparent: true, opacity: 0.9, depthTest: false }));
    this.paths.frustumCulled = false;
    this.paths.renderOrder = 1;
    this.scene.add(this.paths);
  }

  addBolts() {
    const { motion } = this;
    if (!motion.bolts) return;
    this.bolts = new Bolts(motion, motion.bolts, Math.hypot(...motion.about.extent_m));
    this.scene.add(this.bolts.mesh);
  }

  /** Draws the ways up to a frame, displacements times `factor`. */
  showPaths(frame, factor, areShown) {
    const { count, centres } = this.tracks;
    this.paths.visible = areShown && frame > 0;
    this.paths.geometry.setDrawRange(0, 2 * count * frame);
    if (this.pathFactor === factor) return;
    this.pathFactor = factor;
    const ends = this.pathEnds.array;
    const at = (f, i) => centres[i] + factor * (centres[3 * count * f + i] - centres[i]);
    for (let f = 1; f < this.motion.frames; f += 1) {
      for (let i = 0; i < 3 * count; i += 1) {
        const piece = 6 * (count * (f - 1) + Math.floor(i / 3)) + (i % 3);
        ends[piece] = at(f - 1, i);
        ends[piece + 3] = at(f, i);
      }
    }
    this.pathEnds.needsUpdate = true;
  }

  /** Runs of triangles of blocks that move, and of those that do not. */
  groupByRest(faces) {
    const { blocks, still } = this.motion;
    const kind = (triangle) => (still.has(blocks[triangle]) ? 1 : 0);
    for (let first = 0, next = 0; first < blocks.length; first = next) {
      while (next < blocks.length && kind(next) === kind(first)) next += 1;
      faces.addGroup(3 * first, 3 * (next - first), kind(first));
    }
  }

  /** Whether one sees through blocks at rest. */
  makeGlass(isGlass) {
    if (this.resting.transparent === isGlass) return;
    this.resting.transparent = isGlass;
    this.resting.depthWrite = !isGlass;
    this.resting.needsUpdate = true;
  }

  /** Puts all blocks where they are in a frame, displacements times `factor`, coloured by a choice; `rest` says how blocks at rest look. */
  show(frame, choice, factor, { rest, paths, bolts }) {
    this.makeGlass(rest === "glass");
    const { motion, positions } = this;
    const moved = motion.displacements(frame);
    for (let i = 0; i < positions.length; i += 1) {
      positions[i] = motion.start[i] + factor * moved[i];
    }
    this.takeOut(motion.absent(frame));
    const corners = this.corners.array;
    for (let c = 0; c < motion.triangles.length; c += 1) {
      const node = 3 * motion.triangles[c];
      corners[3 * c] = positions[node];
      corners[3 * c + 1] = positions[node + 1];
      corners[3 * c + 2] = positions[node + 2];
    }
    this.paint(choice.values ? choice.values(frame) : null, choice, rest === "plain");
    this.showPaths(frame, factor, paths);
    if (this.bolts) this.bolts.show(frame, factor, bolts);
    for (const changed of [this.corners, this.colours, this.nodes]) {
      changed.needsUpdate = true;
    }
    this.draw();
  }

  /** Draws blocks that are not there as points, which nobody sees. */
  takeOut(absent) {
    if (absent.size === 0) return;
    const { motion, positions } = this;
    const anchors = new Map();
    for (let c = 0; c < motion.triangles.length; c += 1) {
      const block = motion.blocks[Math.floor(c / 3)];
      if (!absent.has(block)) continue;
      const node = 3 * motion.triangles[c];
      if (!anchors.has(block)) anchors.set(block, positions.slice(node, node + 3));
      positions.set(anchors.get(block), node);
    }
  }

  paint(values, choice, coloursStill) {
    const { motion } = this;
    const target = this.colours.array;
    const { least, bottom = least, top } = choice.range || {};
    for (let c = 0; c < motion.triangles.length; c += 1) {
      const triangle = Math.floor(c / 3);
      const block = motion.blocks[triangle];
      if (!coloursStill && motion.still.has(block)) {
        putColour(target, 3 * c, STILL_COLOUR);
      } else if (!values) {
        putColour(target, 3 * c, blockColour(block));
      } else {
        const value = values[choice.of_nodes ? motion.triangles[c] : triangle];
        putColour(target, 3 * c, viridis(top > bottom ? (value - bottom) / (top - bottom) : 0));
      }
    }
  }

  /** The box that is to fit into the picture at all times: what moves and its surroundings, or everything. */
  framed() {
    const half = this.motion.about.extent_m.map((s) => s / 2);
    const whole = { least: half.map((h) => -h), most: half };
    const { least, most } = this.tracks.box;
    if (this.showsWhole || this.tracks.count === 0) return whole;
    const more = SURROUNDINGS * Math.max(...most.map((m, i) => m - least[i]));
    return { least: least.map((x, i) => Math.max(x - more, whole.least[i])), most: most.map((x, i) => Math.min(x + more, whole.most[i])) };
  }

  /** Looks from one side so that the framed blocks fit. */
  look(name) {
    this.view = name;
    const { least, most } = this.framed();
    const size = most.map((m, i) => m - least[i]);
    const middle = most.map((m, i) => (m + least[i]) / 2);
    const radius = Math.max(0.5 * Math.hypot(...size), 1e-6);
    const direction = new THREE.Vector3(...VIEWS[name]).normalize();
    const target = new THREE.Vector3(...middle);
    let distance = radius / Math.tan((LENS_DEG / 360) * Math.PI);
    // Each round centres the box in the picture and takes up what is left of it; a few are enough.
    for (let round = 0; round < 8; round += 1) {
      this.camera.position.copy(direction).multiplyScalar(distance).add(target);
      this.camera.lookAt(target);
      this.fitDepth();
      this.camera.updateMatrixWorld();
      const seen = boxCorners(size, middle).map((corner) => corner.project(this.camera));
      const [left, right] = bounds(seen.map((corner) => corner.x));
      const [below, above] = bounds(seen.map((corner) => corner.y));
      const depth = target.clone().project(this.camera).z;
      target.set((left + right) / 2, (below + above) / 2, depth).unproject(this.camera);
      distance *= Math.max(right - left, above - below) / 1.86;
    }
    this.controls.target.copy(target);
    this.controls.update();
    this.draw();
  }

  /** Whether most of what moves is behind blocks at rest, from where one looks now. */
  hidesMotion() {
    const { blocks, still, triangles } = this.motion;
    const moving = [...blocks.keys()].filter((triangle) => !still.has(blocks[triangle]));
    const every = Math.ceil(moving.length / 40);
    const asked = moving.filter((_, i) => i % every === 0);
    const corner = (c) => new THREE.Vector3().fromArray(this.positions, 3 * triangles[c]);
    const ray = new THREE.Raycaster();
    this.faces.geometry.computeBoundingSphere();
    const hidden = asked.filter((t) => {
      const towards = corner(3 * t).add(corner(3 * t + 1)).add(corner(3 * t + 2)).divideScalar(3).sub(this.camera.position);
      ray.set(this.camera.position, towards.normalize());
      const [hit] = ray.intersectObject(this.faces);
      return hit && still.has(blocks[hit.faceIndex]);
    });
    return hidden.length > 0.5 * asked.length;
  }

  /** The block under a place of the page. */
  blockAt(x, y) {
    const { left, top, width, height } = this.renderer.domElement.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height), this.camera);
    this.faces.geometry.computeBoundingSphere();
    const { blocks, still } = this.motion;
    const isSeen = (hit) => !(this.resting.transparent && still.has(blocks[hit.faceIndex]));
    const hit = ray.intersectObject(this.faces).find(isSeen);
    return hit ? blocks[hit.faceIndex] : null;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.view) this.look(this.view);
    else this.draw();
  }

  /** Depths between which all blocks are, magnified ones included. */
  fitDepth() {
    const reach = 2 * Math.hypot(...this.motion.about.extent_m) * Math.max(this.pathFactor || 1, 1) + 1e-6;
    const distance = this.camera.position.length();
    this.camera.near = Math.max(distance - reach, 1e-3 * distance);
    this.camera.far = distance + reach;
    this.camera.updateProjectionMatrix();
  }

  /** Pixels of the page that a metre is long at the middle of the view. */
  pixelsPerMetre() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return this.box.clientHeight / (2 * distance * Math.tan((LENS_DEG / 360) * Math.PI));
  }

  draw() {
    this.fitDepth();
    this.renderer.render(this.scene, this.camera);
    if (this.drawn) this.drawn();
  }
}

const bounds = (values) => [Math.min(...values), Math.max(...values)];

/** Corners of a box. */
function boxCorners(size, middle) {
  const corner = (i) => size.map((s, axis) => middle[axis] + ((i >> axis) & 1 ? 0.5 : -0.5) * s);
  return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => new THREE.Vector3(...corner(i)));
}
