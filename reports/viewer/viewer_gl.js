// Draws one frame of a case with WebGL 2: cloth and objects with the shadows of one light, as the pictures are drawn.

const SHADOW_TEXELS = 1024;

const VERTEX = `#version 300 es
in vec3 position, normal; in float code, mark;
uniform mat3 turn; uniform vec3 move;            // the pose of the mesh
uniform mat3 axes; uniform vec3 centre;          // right, up, toward the viewer; what is turned about [m]
uniform vec4 frame; uniform float depth, back;   // where the picture's middle is and half its size; half its depth [m]
uniform mat3 lightAxes; uniform float lightSize; // the same of the light [m]
uniform float dotSize;                             // pixels; 0: no particles are drawn
out vec3 seenNormal, inLight, along; out float bar; flat out float marked;
void main() {
  vec3 place = turn * position + move - centre;
  vec3 seen = place * axes;
  gl_Position = vec4((seen.xy - frame.xy) / frame.zw, (back - seen.z) / depth, 1.0);
  gl_PointSize = mark > 0.5 ? dotSize : 0.0;
  seenNormal = (turn * normal) * axes;
  inLight = place * lightAxes / lightSize;
  vec3 upright = turn * normal;
  along = place - upright * dot(upright, place);   // of ground: from below the middle of the cloth [m]
  bar = code; marked = mark;
}`;

const SURFACE = `#version 300 es
precision highp float; precision highp sampler2DShadow;
in vec3 seenNormal, inLight, along; in float bar; out vec4 pixel;
uniform sampler2DShadow shadow; uniform sampler2D colours;
uniform vec3 front, behind, keyLight, fillLight, fades;  // lights in the axes of the viewer; fades: from, to, reach [m]
uniform float field, ground;
float reached(float towards) {
  float cosine = clamp(towards, 0.2, 1.0);
  float least = -inLight.z - (1.5 + 2.0 * sqrt(1.0 - cosine * cosine) / cosine) * ${(2 / SHADOW_TEXELS).toFixed(6)};
  float lit = 0.0;
  for (int tap = 0; tap < 8; ++tap) {
    float angle = 2.4 * float(tap), radius = ${(5.2 / SHADOW_TEXELS).toFixed(6)} * sqrt((float(tap) + 0.5) / 8.0);
    vec3 look = vec3(inLight.xy + radius * vec2(cos(angle), sin(angle)), least);
    lit += texture(shadow, 0.5 + 0.5 * look) / 8.0;
  }
  return lit;
}
void main() {
  vec3 normal = normalize(seenNormal) * (gl_FrontFacing ? 1.0 : -1.0);
  normal.z = abs(normal.z);
  vec3 colour = field > 0.5 ? pow(texture(colours, vec2(bar, 0.5)).rgb, vec3(2.2)) : gl_FrontFacing ? front : behind;
  float towards = dot(normal, keyLight);
  float key = reached(towards) * clamp((towards + 0.16) / 1.16, 0.0, 1.0), turned = 1.0 - normal.z;
  float light = 0.20 + 0.22 * (0.5 + 0.5 * normal.y) + 0.98 * key * sqrt(key) + 0.14 * max(dot(normal, fillLight), 0.0);
  float shine = 0.08 * turned * turned * turned + 0.03 * key * key * key * key;
  colour = field > 0.5 ? colour * (0.40 + 0.52 * light) : colour * light + (ground > 0.5 ? 0.0 : shine);
  float cover = ground > 0.5 ? smoothstep(0.0, 1.0, (fades.y - length(along) / fades.z) / (fades.y - fades.x)) : 1.0;
  pixel = vec4(pow(clamp(colour, 0.0, 1.0), vec3(1.0 / 2.2)) * cover, cover);
}`;

const PLAIN = `#version 300 es
precision highp float;
flat in float marked; out vec4 pixel; uniform vec4 ink, held, stuck; uniform float dotSize;
void main() {
  if (dotSize < 0.5) { pixel = ink; return; }
  if (marked < 0.5) discard;
  float away = length(gl_PointCoord - 0.5) * 2.0;
  if (away > 1.0) discard;
  pixel = away > 0.68 ? vec4(0.97) : marked > 1.5 ? stuck : held;
}`;

/** The pens of one canvas; it draws whatever case it is given. Throws where the browser has no WebGL 2. */
function makePainter(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
  if (!gl) throw new Error("no WebGL 2");
  const surface = programOf(gl, SURFACE), plain = programOf(gl, PLAIN);
  const shadow = shadowOf(gl), bar = gl.createTexture();
  let held = null;                                       // buffers of the case that is shown

  function load(scene) {
    unload();
    held = { cloth: meshOf(gl, scene.cloth), objects: scene.objects.map((part) => meshOf(gl, part)), frame: -1, field: -2 };
    held.edges = indexBuffer(gl, scene.cloth.edges);
    held.lightSize = extentOf(scene, false);
    held.depth = extentOf(scene, true);
  }

  function unload() {
    if (!held) return;
    for (const mesh of [held.cloth, ...held.objects]) mesh.free();
    gl.deleteBuffer(held.edges);
    held = null;
  }

  /** view: frame, field (-1: two sides), axes (right, up, toward), pan, halfSize [m], edges, pixels (per CSS pixel). */
  function draw(scene, view) {
    if (view.frame !== held.frame) place(scene, view.frame);
    if (view.frame !== held.frame || view.field !== held.field) colour(scene, view);
    held.frame = view.frame; held.field = view.field;
    drawShadow(scene, view);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    drawSurfaces(scene, view);
    drawMarks(scene, view);
  }

  function place(scene, frame) {
    held.cloth.place(placesIn(scene.cloth, frame), scene.cloth.triangles);
    scene.objects.forEach((part, k) => {
      if (part.deforms || held.frame < 0) held.objects[k].place(placesIn(part, frame), part.triangles);
    });
    const start = frame * scene.particles;
    held.cloth.fill("mark", Float32Array.from(scene.marks.subarray(start, start + scene.particles)));
  }

  function colour(scene, view) {
    const field = scene.fields[view.field];
    if (!field) return;
    const start = view.frame * scene.particles;
    held.cloth.fill("code", Float32Array.from(field.codes.subarray(start, start + scene.particles), (code) => code / 255));
    fillBar(gl, bar, scene.maps[field.colours]);
  }

  function useProgram(program, scene, axes, frame) {
    gl.useProgram(program.name);
    const light = lightAxes(scene.look.light);
    program.set({ axes, centre: scene.look.centre, frame, depth: held.depth, back: 0, lightAxes: light,
      lightSize: held.lightSize, turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], move: [0, 0, 0], dotSize: 0 });
    return light;
  }

  function drawShadow(scene, view) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, shadow.frame);
    gl.viewport(0, 0, SHADOW_TEXELS, SHADOW_TEXELS);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    const size = held.lightSize;
    useProgram(plain, scene, lightAxes(scene.look.light), [0, 0, size, size]);
    plain.set({ depth: size, ink: [0, 0, 0, 0] });
    held.cloth.draw();
    scene.objects.forEach((part, k) => { if (!part.ground) { plain.set(poseOf(part, view.frame)); held.objects[k].draw(); } });
  }

  function drawSurfaces(scene, view) {
    const { look } = scene, frame = [...view.pan, ...view.halfSize];
    useProgram(surface, scene, view.axes, frame);
    const seen = (v) => [0, 1, 2].map((row) => view.axes[3 * row] * v[0] + view.axes[3 * row + 1] * v[1] + view.axes[3 * row + 2] * v[2]);
    gl.activeTexture(gl.TEXTURE0); gl.bindTexture(gl.TEXTURE_2D, shadow.texture);
    gl.activeTexture(gl.TEXTURE1); gl.bindTexture(gl.TEXTURE_2D, bar);
    surface.set({ shadow: 0, colours: 1, keyLight: seen(look.light), fillLight: look.fill, fades: [...look.fades, look.reach] });
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    surface.set({ front: look.inks.front, behind: look.inks.back, field: view.field >= 0 ? 1 : 0, ground: 0 });
    held.cloth.draw();
    gl.enable(gl.BLEND);                                 // the ground comes last: it is seen through at its end
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    for (const ground of [false, true]) scene.objects.forEach((part, k) => {
      if (part.ground !== ground) return;
      const ink = ground ? look.inks.ground : look.inks.object;
      surface.set({ ...poseOf(part, view.frame), front: ink, behind: ink, field: 0, ground: ground ? 1 : 0, back: look.setBack });
      held.objects[k].draw();
    });
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  function drawMarks(scene, view) {
    const ink = (name) => [...scene.look.inks[name].map((c) => c ** (1 / 2.2)), 1];
    useProgram(plain, scene, view.axes, [...view.pan, ...view.halfSize]);
    plain.set({ ink: [0.02, 0.02, 0.02, 0.28].map((c, k) => (k < 3 ? 0.28 * c : c)), held: ink("held"), stuck: ink("stuck") });
    if (view.edges) held.cloth.draw(gl.LINES, held.edges, scene.cloth.edges.length);
    plain.set({ dotSize: 9 * view.pixels, back: -0.3 * scene.look.setBack });
    held.cloth.points(scene.particles);
  }

  return { load, unload, draw, isLost: () => gl.isContextLost() };
}

function programOf(gl, fragment) {
  const name = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(name, shader);
  }
  ["position", "normal", "code", "mark"].forEach((attribute, k) => gl.bindAttribLocation(name, k, attribute));
  gl.linkProgram(name);
  if (!gl.getProgramParameter(name, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(name));
  const kinds = {};
  for (let k = 0; k < gl.getProgramParameter(name, gl.ACTIVE_UNIFORMS); ++k) {
    const about = gl.getActiveUniform(name, k);
    kinds[about.name] = { type: about.type, at: gl.getUniformLocation(name, about.name) };
  }
  function set(values) {                                 // what a program does not use is passed over
    for (const [key, value] of Object.entries(values)) {
      const kind = kinds[key];
      if (!kind) continue;
      if (kind.type === gl.FLOAT) gl.uniform1f(kind.at, value);
      else if (kind.type === gl.FLOAT_VEC3) gl.uniform3fv(kind.at, value);
      else if (kind.type === gl.FLOAT_VEC4) gl.uniform4fv(kind.at, value);
      else if (kind.type === gl.FLOAT_MAT3) gl.uniformMatrix3fv(kind.at, false, value);
      else gl.uniform1i(kind.at, value);
    }
  }
  return { name, set };
}

function shadowOf(gl) {
  const texture = gl.createTexture(), frame = gl.createFramebuffer();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_TEXELS, SHADOW_TEXELS);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.drawBuffers([gl.NONE]);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, frame };
}

function indexBuffer(gl, indices) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
  return buffer;
}

function meshOf(gl, mesh) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  const buffers = {};
  ["position", "normal", "code", "mark"].forEach((name, k) => {
    buffers[name] = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, 4 * mesh.vertices * (k < 2 ? 3 : 1), gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, k < 2 ? 3 : 1, gl.FLOAT, false, 0, 0);
  });
  gl.bindVertexArray(null);
  const triangles = indexBuffer(gl, mesh.triangles);
  function fill(name, values) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
  }
  function draw(kind = gl.TRIANGLES, indices = triangles, count = mesh.triangles.length) {
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    gl.drawElements(kind, count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }
  return {
    fill, draw,
    place(places, faces) { fill("position", places); fill("normal", normalsOf(places, faces)); },
    points(count) { gl.bindVertexArray(array); gl.drawArrays(gl.POINTS, 0, count); gl.bindVertexArray(null); },
    free() { gl.deleteVertexArray(array); [...Object.values(buffers), triangles].forEach((buffer) => gl.deleteBuffer(buffer)); },
  };
}

function fillBar(gl, texture, stops) {
  gl.activeTexture(gl.TEXTURE1);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  const fine = new Uint8Array(4 * 256);
  for (let k = 0; k < 256; ++k) {
    const at = k / 255 * (stops.length - 1), low = Math.min(Math.floor(at), stops.length - 2);
    for (let c = 0; c < 3; ++c) fine[4 * k + c] = stops[low][c] + (at - low) * (stops[low + 1][c] - stops[low][c]);
    fine[4 * k + 3] = 255;
  }
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, fine);
  for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.LINEAR);
}

/** Right, up and toward the light, as the columns of a matrix. */
function lightAxes(light) {
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const right = cross(Math.abs(light[1]) < 0.95 ? [0, 1, 0] : [0, 0, -1], light);
  const length = Math.hypot(...right), unit = right.map((value) => value / length);
  return [...unit, ...cross(light, unit), ...light];
}

/** The rotation (columns) and the translation of a rigid object in a frame. */
function poseOf(part, frame) {
  if (part.deforms) return { turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], move: [0, 0, 0] };
  const start = part.poses.length > 7 ? 7 * frame : 0;
  const [w, x, y, z, ...move] = part.poses.subarray(start, start + 7);
  return { move, turn: [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),
    2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
    2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)] };
}

/** How far cloth and objects go from the centre in any frame [m]; with or without the ground. */
function extentOf(scene, withGround) {
  const far = (mesh, pose) => {
    const { low, step } = mesh.box, ends = [0, 1, 2].map((axis) => [low[axis], low[axis] + 65535 * step[axis]]);
    let most = 0;
    for (const x of ends[0]) for (const y of ends[1]) for (const z of ends[2]) {
      const at = [0, 1, 2].map((row) => pose.turn[row] * x + pose.turn[3 + row] * y + pose.turn[6 + row] * z + pose.move[row]);
      most = Math.max(most, Math.hypot(...at.map((value, axis) => value - scene.look.centre[axis])));
    }
    return most;
  };
  let most = far(scene.cloth, { turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], move: [0, 0, 0] });
  for (const part of scene.objects) if (withGround || !part.ground)
    scene.times.forEach((_, frame) => { most = Math.max(most, far(part, poseOf(part, frame))); });
  return 1.05 * most;
}
