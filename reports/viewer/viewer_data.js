// Unpacks what view_data.py packed: base64, raw deflate, a JSON header, arrays of differences.

/** The case in a <template>: its header, and arrays by name. */
async function unpack(text) {
  const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const inflated = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(inflated).arrayBuffer());
  const length = new DataView(bytes.buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  const arrays = {};
  let at = 4 + length;
  for (const { name, kind, count } of header.arrays) {
    const size = kind === "floats" ? 4 : kind;
    const part = bytes.subarray(at, at + size * count);
    arrays[name] = kind === "floats" ? new Float32Array(part.slice().buffer) : wholeNumbers(part, size, count);
    at += size * count;
  }
  return caseOf(header, arrays);
}

/** All lowest bytes, then all second bytes, ...; the lowest bit is the sign. */
function wholeNumbers(bytes, size, count) {
  const numbers = new Int32Array(count);
  for (let k = 0; k < count; ++k) {
    let value = 0;
    for (let plane = size - 1; plane >= 0; --plane) value = (value << 8) | bytes[plane * count + k];
    numbers[k] = (value >>> 1) ^ -(value & 1);
  }
  return numbers;
}

/** Undoes differences: to the frame before, in the first frame to the neighbour before (in runs of `run` numbers). */
function overTime(numbers, perFrame, run, mask) {
  const codes = mask > 255 ? new Uint16Array(numbers.length) : new Uint8Array(numbers.length);
  for (let k = 0; k < numbers.length; ++k) {
    const before = k >= perFrame ? codes[k - perFrame] : k % run ? codes[k - 1] : 0;
    codes[k] = (before + numbers[k]) & mask;
  }
  return codes;
}

function along(numbers) {
  const indices = new Uint32Array(numbers.length);
  let value = 0;
  for (let k = 0; k < numbers.length; ++k) indices[k] = value += numbers[k];
  return indices;
}

/** The header with meshes: a mesh has vertices, triangles, and codes of its places, all frames one after the other. */
function caseOf(header, arrays) {
  const mesh = (name, vertices, box, triangles) => ({
    vertices, box, triangles: along(arrays[triangles]), codes: overTime(arrays[name], 3 * vertices, vertices, 0xffff),
  });
  const bytes = (name) => overTime(arrays[name], header.particles, header.particles, 0xff);
  header.cloth = mesh("positions", header.particles, header.box, "triangles");
  header.cloth.edges = edgesOf(header.cloth.triangles);
  header.marks = bytes("marks");
  header.fields.forEach((field, k) => { field.codes = bytes(`field ${k}`); });
  header.objects.forEach((part, k) => {
    Object.assign(part, mesh(`object ${k}`, part.vertices, part.box, `object ${k} triangles`));
    part.poses = arrays[`object ${k} poses`];
  });
  return header;
}

function edgesOf(triangles) {
  const seen = new Set(), edges = [];
  for (let k = 0; k < triangles.length; ++k) {
    const a = triangles[k], b = triangles[k % 3 === 2 ? k - 2 : k + 1];
    const key = `${Math.min(a, b)} ${Math.max(a, b)}`;
    if (!seen.has(key)) { seen.add(key); edges.push(a, b); }
  }
  return new Uint32Array(edges);
}

/** Places of a mesh in one frame, 3 for each vertex [m]. */
function placesIn(mesh, frame) {
  const { vertices, box, codes } = mesh;
  const start = codes.length > 3 * vertices ? 3 * vertices * frame : 0;
  const places = new Float32Array(3 * vertices);
  for (let axis = 0; axis < 3; ++axis)
    for (let k = 0; k < vertices; ++k)
      places[3 * k + axis] = box.low[axis] + box.step[axis] * codes[start + axis * vertices + k];
  return places;
}

/** Unit normals at the vertices: of the triangles around each, weighted with their areas. */
function normalsOf(places, triangles) {
  const normals = new Float32Array(places.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const [ux, uy, uz] = [places[b] - places[a], places[b + 1] - places[a + 1], places[b + 2] - places[a + 2]];
    const [vx, vy, vz] = [places[c] - places[a], places[c + 1] - places[a + 1], places[c + 2] - places[a + 2]];
    const normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const corner of [a, b, c]) for (let axis = 0; axis < 3; ++axis) normals[corner + axis] += normal[axis];
  }
  for (let k = 0; k < normals.length; k += 3) {
    const length = Math.hypot(normals[k], normals[k + 1], normals[k + 2]) || 1;
    for (let axis = 0; axis < 3; ++axis) normals[k + axis] /= length;
  }
  return normals;
}
