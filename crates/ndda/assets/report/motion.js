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
    this.still = new Set(description.still);
  }

  /** Displacements of all nodes in a frame, in metres. */
  displacements(frame) {
    return decoded(this.moved, frame, this.frames, this.about.moved);
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
