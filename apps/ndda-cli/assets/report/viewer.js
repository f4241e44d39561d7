// The blocks in 3D: triangles and edges that follow the frames, a camera that turns about them.
"use strict";

const VIEWS = { iso: [0.55, -1, 0.5], front: [0, -1, 0.001], side: [1, 0, 0.001], top: [0, -0.001, 1] };

class Viewer {
  constructor(box, motion) {
    this.box = box;
    this.motion = motion;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    box.prepend(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.addLight();
    this.addBlocks();
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.resize()).observe(box);
    this.resize();
    this.look("iso");
  }

  addLight() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8d8578, 1.7));
    const sun = new THREE.DirectionalLight(0xffffff, 1.9);
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
    const rock = { vertexColors: true, flatShading: true, side: THREE.DoubleSide };
    this.faces = new THREE.Mesh(faces, new THREE.MeshLambertMaterial(
      { ...rock, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
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

  /** Puts all blocks where they are in a frame, displacements times `factor`, coloured by a choice. */
  show(frame, choice, factor, coloursStill) {
    const { motion, positions } = this;
    const moved = motion.displacements(frame);
    for (let i = 0; i < positions.length; i += 1) {
      positions[i] = motion.start[i] + factor * moved[i];
    }
    const corners = this.corners.array;
    for (let c = 0; c < motion.triangles.length; c += 1) {
      const node = 3 * motion.triangles[c];
      corners[3 * c] = positions[node];
      corners[3 * c + 1] = positions[node + 1];
      corners[3 * c + 2] = positions[node + 2];
    }
    this.paint(choice.values ? choice.values(frame) : null, choice, coloursStill);
    for (const changed of [this.corners, this.colours, this.nodes]) {
      changed.needsUpdate = true;
    }
    this.draw();
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

  /** Looks from one side so that all blocks fit at all times. */
  look(name) {
    const size = new THREE.Vector3(...this.motion.about.extent_m);
    const radius = Math.max(0.5 * size.length(), 1e-6);
    const direction = new THREE.Vector3(...VIEWS[name]).normalize();
    this.camera.near = radius / 200;
    this.camera.far = radius * 40;
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(direction);
    this.camera.lookAt(0, 0, 0);
    this.camera.updateMatrixWorld();
    this.camera.position.multiplyScalar(this.fittingDistance(size));
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /** Distance from which the eight corners of a box are in the picture. */
  fittingDistance(size) {
    const toCamera = this.camera.matrixWorld.clone().invert();
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    let distance = 0;
    for (let i = 0; i < 8; i += 1) {
      const sign = (bit) => (i & bit ? 0.5 : -0.5);
      const corner = new THREE.Vector3(sign(1) * size.x, sign(2) * size.y, sign(4) * size.z).applyMatrix4(toCamera);
      // The camera is at a distance of 1 while this is asked.
      const away = Math.max(Math.abs(corner.y) / slope, Math.abs(corner.x) / (slope * this.camera.aspect));
      distance = Math.max(distance, corner.z + 1 + away);
    }
    return 1.06 * distance;
  }

  /** The block under a place of the page. */
  blockAt(x, y) {
    const { left, top, width, height } = this.renderer.domElement.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height), this.camera);
    this.faces.geometry.computeBoundingSphere();
    const [hit] = ray.intersectObject(this.faces);
    return hit ? this.motion.blocks[hit.faceIndex] : null;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
  }
}
