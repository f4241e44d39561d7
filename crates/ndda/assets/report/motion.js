// The numbers of the motion: unpacked once, then positions and values of any frame.
"use strict";

/** Bytes of a deflated text in base 64. */
async function inflated(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

class Motion {
  constructor(description, buffer) {
    this.about = description;
    this.frames = description.times_s.length;
    const at = Object.fromEntries(description.arrays.map((array) => [array.name, array]));
    const typed = (Type, name) => new Type(buffer, at[name].offset, at[name].length / Type.BYTES_PER_ELEMENT);
    this.start = typed(Float32Array, "start");
    this.triangles = typed(Uint32Array, "triangles");
    this.blocks = typed(Uint32Array, "blocks");
    this.edges = typed(Uint32Array, "edges");
    const codes = (name) => sums(typed(Uint8Array, name), this.frames);
    this.moved = codes("moved");
    this.fields = description.fields.map((field) => ({ ...field, codes: codes(field.array) }));
    this.bolts = description.bolts ? typed(Float32Array, "bolts") : null;
    this.still = new Set(description.still);
  }

  /** Displacements of all nodes in a frame, in metres. */
  displacements(frame) {
    return decoded(this.moved, frame, this.frames, this.about.moved);
  }

  /** The centres of the blocks that move in all frames, three numbers per block and frame, and the box of all their nodes. */
  tracks() {
    const blockOf = new Int32Array(this.start.length / 3).fill(-1);
    this.triangles.forEach((node, c) => { blockOf[node] = this.blocks[Math.floor(c / 3)]; });
    const moving = [...new Set(this.blocks)].filter((block) => !this.still.has(block));
    const place = new Map(moving.map((block, i) => [block, i]));
    const count = moving.length;
    const centres = new Float32Array(3 * count * this.frames);
    const nodes = new Uint32Array(count);
    blockOf.forEach((block) => { if (place.has(block)) nodes[place.get(block)] += 1; });
    const box = { least: [Infinity, Infinity, Infinity], most: [-Infinity, -Infinity, -Infinity] };
    for (let frame = 0; frame < this.frames; frame += 1) {
      const moved = this.displacements(frame);
      for (let i = 0; i < moved.length; i += 1) {
        const block = place.get(blockOf[Math.floor(i / 3)]);
        if (block === undefined) continue;
        const [axis, x] = [i % 3, this.start[i] + moved[i]];
        centres[3 * (count * frame + block) + axis] += x / nodes[block];
        box.least[axis] = Math.min(box.least[axis], x);
        box.most[axis] = Math.max(box.most[axis], x);
      }
    }
    return { count, centres, box };
  }

  /** Blocks that are not there in a frame. */
  absent(frame) {
    return new Set(this.about.absent ? this.about.absent[frame] : []);
  }

  /** One value per node or triangle in a frame. */
  values(field, frame) {
    return decoded(field.codes, frame, this.frames, field.range);
  }
}

/** Codes of all frames from differences, whose low bytes come first. */
function sums(bytes, frames) {
  const count = bytes.length / 2;
  const codes = new Uint16Array(count);
  const perFrame = count / frames;
  for (let i = 0; i < count; i += 1) {
    codes[i] = (bytes[i] | (bytes[count + i] << 8)) + (i < perFrame ? 0 : codes[i - perFrame]);
  }
  return codes;
}

function decoded(codes, frame, frames, range) {
  const count = codes.length / frames;
  const step = (range.largest - range.least) / 65535;
  const values = new Float32Array(count);
  for (let i = 0; i < count; i += 1) {
    values[i] = range.least + step * codes[frame * count + i];
  }
  return values;
}
