// SPDX-License-Identifier: MIT
// The arrays of a report. C++ (support/html_report.cpp) packs them; here they are unpacked.
//
// Every array is coded as unsigned differences, folded so that small negative ones are small too, its bytes in planes (all
// lowest bytes first), zlib-compressed, in base64.

/** Bytes of a zlib stream in base64. */
async function inflate(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) {
    bytes[i] = binary.charCodeAt(i);
  }
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const unfold = (code) => (code >>> 1) ^ -(code & 1);

function expectSize(bytes, size) {
  if (bytes.length !== size) {
    throw new Error(`an array of the report has ${bytes.length} bytes, expected ${size}`);
  }
}

/** Indices: differences from one to the next. */
export async function unpackIndices(text, count) {
  const bytes = await inflate(text);
  expectSize(bytes, 4 * count);
  const result = new Uint32Array(count);
  let value = 0;
  for (let i = 0; i < count; ++i) {
    const code =
      bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24);
    value = (value + unfold(code)) | 0;
    result[i] = value;
  }
  return result;
}

/**
 * Places on the grid of 16 bits, per frame x, y and z of all vertices: differences from the reference mesh, from the frame
 * before, from the vertex before.
 */
export async function unpackPositions(text, frames, vertices, reference) {
  const bytes = await inflate(text);
  const row = 3 * vertices;
  const count = frames * row;
  expectSize(bytes, 2 * count);
  const result = new Uint16Array(count);
  for (let frame = 0; frame < frames; ++frame) {
    for (let axis = 0; axis < 3; ++axis) {
      let change = 0;
      const begin = frame * row + axis * vertices;
      for (let i = begin; i < begin + vertices; ++i) {
        change += unfold(bytes[i] | (bytes[count + i] << 8));
        result[i] = frame > 0 ? result[i - row] + change : change;
      }
    }
  }
  if (reference) {
    for (let i = 0; i < count; ++i) {
      result[i] += reference[i];
    }
  }
  return result;
}

/** Values in steps of 1/254 of their range, 255 where there is none: differences from the frame and the vertex before. */
export async function unpackValues(text, frames, vertices) {
  const bytes = await inflate(text);
  expectSize(bytes, frames * vertices);
  const result = new Uint8Array(frames * vertices);
  for (let frame = 0; frame < frames; ++frame) {
    let change = 0;
    for (let i = frame * vertices; i < (frame + 1) * vertices; ++i) {
      change += unfold(bytes[i]);
      result[i] = frame > 0 ? result[i - vertices] + change : change;
    }
  }
  return result;
}
