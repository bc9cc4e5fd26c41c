// The view of a case: its controls, and what mouse, touch and keys do. One canvas serves the whole page, since browsers
// allow few; it moves to the case that is opened, whose picture comes back when another is.

const STEP = Math.PI / 24;            // that an arrow key turns [rad]
const ZOOM = 1.15;                    // of a key, or of a notch of the wheel
const REST = 0.6;                     // seconds that a film stands still before it begins again

let shared = null;                    // { canvas, painter, close }: the one view that is open

for (const figure of document.querySelectorAll("figure.view")) offer(figure);

/** Puts the button on a case's picture. */
function offer(figure) {
  const stage = figure.querySelector(".stage");
  const button = element("button", { type: "button", className: "open-view" }, "Turn and play");
  button.setAttribute("aria-label", `Turn and play: ${figure.dataset.title}`);
  button.addEventListener("click", () => open(figure, button).catch((error) => {
    console.warn(error);
    button.replaceWith(element("p", { className: "no-view" }, `Only the picture: ${error.message}`));
  }));
  stage.append(button);
}

async function open(figure, button) {
  button.disabled = true;
  const scene = await unpack(figure.querySelector("template").content.textContent);
  if (shared && shared.painter && shared.painter.isLost()) shared = null;
  if (shared && shared.close) shared.close();
  if (!shared) {
    const canvas = element("canvas", { tabIndex: 0 });
    shared = { canvas, painter: makePainter(canvas), close: null };
  }
  start(figure, button, scene, shared);
}

/** Runs the view of a case until it is closed. */
function start(figure, button, scene, page) {
  const { canvas, painter } = page, stage = figure.querySelector(".stage");
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const first = scene.fields.findIndex((field) => field.name === figure.dataset.field);
  const camera = cameraOf(scene);
  const state = { frame: Number(figure.dataset.frame) || 0, field: first, edges: false, playing: !still, clock: 0, seen: true };
  state.clock = scene.times[state.frame] - scene.times[0];
  const controls = controlsOf(figure, scene, state, { changed, reset: () => { camera.reset(); changed(); }, close });
  let waiting = 0, before = 0;

  function changed() {
    controls.show();
    if (!waiting) waiting = requestAnimationFrame(tick);
  }

  function tick(now) {
    waiting = 0;
    if (page.close !== close) return;
    if (state.playing && state.seen) {
      advance(scene, state, Math.min(0.1, before ? (now - before) / 1000 : 0));
      before = now;
      controls.show();
      waiting = requestAnimationFrame(tick);
    } else {
      before = 0;
    }
    paint();
  }

  function paint() {
    const pixels = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [stage.clientWidth, stage.clientHeight].map((size) => Math.max(1, Math.round(size * pixels)));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const halfSize = camera.halfSize(width / height);
    painter.draw(scene, { ...state, axes: camera.axes(), pan: camera.pan, halfSize, pixels });
    controls.showScale(2 * halfSize[0], stage.clientWidth);
    figure.dataset.drawn = Number(figure.dataset.drawn || 0) + 1;
  }

  function close() {
    page.close = null;
    watch.disconnect();
    resized.disconnect();
    stopListening.abort();
    painter.unload();
    controls.remove();
    canvas.remove();
    figure.classList.remove("running");
    button.disabled = false;
  }

  const stopListening = new AbortController();
  const watch = new IntersectionObserver(([entry]) => { state.seen = entry.isIntersecting; if (state.seen) changed(); });
  const resized = new ResizeObserver(changed);
  painter.load(scene);
  page.close = close;
  figure.classList.add("running");
  canvas.setAttribute("aria-label", `${figure.dataset.title}: turn with the arrow keys, zoom with + and \u2212, play with the space bar`);
  stage.append(canvas);
  stage.after(controls.bar);
  listen(canvas, stopListening.signal, { scene, camera, state, changed, close });
  watch.observe(stage);
  resized.observe(stage);
  canvas.focus({ preventScroll: true });
  changed();
}

/** Moves the clock of a film on by so many seconds of the reader's, and takes the last frame that is not later. */
function advance(scene, state, seconds) {
  const { times, slowed } = scene, length = times[times.length - 1] - times[0];
  state.clock += seconds / slowed;
  if (state.clock > length + REST / slowed) state.clock = 0;
  state.frame = frameAt(times, times[0] + Math.min(state.clock, length));
}

function frameAt(times, time) {
  let frame = 0;
  while (frame + 1 < times.length && times[frame + 1] <= time + 1e-9) ++frame;
  return frame;
}

/** An orthographic camera that turns about the middle of the cloth; it begins as that of the pictures. Its angles are about
 * the case's up, from its front: `upright` has side, up and front as rows. */
function cameraOf(scene) {
  const { toward, pan, metres, upright } = scene.look;
  const seen = [0, 3, 6].map((row) => [0, 1, 2].reduce((sum, k) => sum + upright[row + k] * toward[k], 0));  // toward, in upright axes
  const world = (side, up, front) => [0, 1, 2].map((k) => upright[k] * side + upright[3 + k] * up + upright[6 + k] * front);
  const camera = {
    reset() {
      Object.assign(camera, { azimuth: Math.atan2(seen[0], seen[2]), elevation: Math.asin(seen[1]), pan: [...pan], zoom: 1 });
    },
    axes() {                                             // right, up, toward the viewer
      const [sa, ca, se, ce] = [Math.sin(camera.azimuth), Math.cos(camera.azimuth), Math.sin(camera.elevation), Math.cos(camera.elevation)];
      return [...world(ca, 0, -sa), ...world(-sa * se, ce, -ca * se), ...world(sa * ce, se, ca * ce)];
    },
    halfSize(aspect) {                                   // [m]; all of the picture is seen, whatever the shape of the canvas
      const height = Math.max(metres[1], metres[0] / aspect) / camera.zoom;
      return [0.5 * height * aspect, 0.5 * height];
    },
    turn(right, up) {
      camera.azimuth -= right;
      camera.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, camera.elevation + up));
    },
    move(right, up) { camera.pan[0] -= right; camera.pan[1] -= up; },
    scale(factor) { camera.zoom = Math.max(0.2, Math.min(60, camera.zoom * factor)); },
  };
  camera.reset();
  return camera;
}

/** Mouse, touch and keys. */
function listen(canvas, signal, { scene, camera, state, changed, close }) {
  const fingers = new Map();
  const metresOf = (pixels) => 2 * camera.halfSize(canvas.clientWidth / canvas.clientHeight)[1] / canvas.clientHeight * pixels;
  const on = (kind, act) => canvas.addEventListener(kind, act, { signal, passive: false });
  on("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); fingers.set(event.pointerId, event); canvas.focus({ preventScroll: true }); event.preventDefault(); });
  for (const kind of ["pointerup", "pointercancel"]) on(kind, (event) => fingers.delete(event.pointerId));
  on("contextmenu", (event) => event.preventDefault());
  on("pointermove", (event) => {
    const was = fingers.get(event.pointerId);
    if (!was) return;
    const [right, down] = [event.clientX - was.clientX, event.clientY - was.clientY];
    if (fingers.size > 1) {
      const other = [...fingers.values()].find((finger) => finger.pointerId !== event.pointerId);
      const apart = (finger) => Math.hypot(finger.clientX - other.clientX, finger.clientY - other.clientY);
      camera.scale(apart(event) / Math.max(1, apart(was)));
      camera.move(metresOf(0.5 * right), -metresOf(0.5 * down));
    } else if (event.shiftKey || was.button === 1 || was.button === 2) camera.move(metresOf(right), -metresOf(down));
    else camera.turn(right * 0.008, down * 0.008);
    fingers.set(event.pointerId, { pointerId: event.pointerId, clientX: event.clientX, clientY: event.clientY, button: was.button });
    changed();
  });
  on("wheel", (event) => {                               // only once the view has the focus: else the page scrolls
    if (document.activeElement !== canvas) return;
    camera.scale(event.deltaY < 0 ? ZOOM : 1 / ZOOM);
    event.preventDefault();
    changed();
  });
  on("pointerleave", () => { if (!fingers.size) canvas.blur(); });
  on("keydown", (event) => {
    const [right, up] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] || [0, 0];
    const tenth = 0.2 * camera.halfSize(1)[1];
    if (right || up) event.shiftKey ? camera.move(right * tenth, up * tenth) : camera.turn(right * STEP, -up * STEP);
    else if (event.key === "+" || event.key === "=") camera.scale(ZOOM);
    else if (event.key === "-") camera.scale(1 / ZOOM);
    else if (event.key === " ") state.playing = !state.playing;
    else if (event.key === "," || event.key === ".") goTo(scene, state, state.frame + (event.key === "." ? 1 : -1));
    else if (event.key === "Home") camera.reset();
    else if (event.key === "Escape") return close();
    else return;
    event.preventDefault();
    changed();
  });
}

function goTo(scene, state, frame) {
  state.frame = Math.max(0, Math.min(scene.times.length - 1, frame));
  state.clock = scene.times[state.frame] - scene.times[0];
  state.playing = false;
}

/** The row of controls under the view, and the colour bar beside it. */
function controlsOf(figure, scene, state, { changed, reset, close }) {
  const play = element("button", { type: "button", className: "play" });
  const slider = element("input", { type: "range", min: 0, max: scene.times.length - 1, step: 1 });
  const time = element("output", { className: "time" });
  const colours = element("select", {}, element("option", { value: -1 }, "two sides"),
    ...scene.fields.map((field, k) => element("option", { value: k }, field.label.split(",")[0])));
  const edges = element("input", { type: "checkbox" });
  const again = element("button", { type: "button" }, "Reset"), shut = element("button", { type: "button" }, "Close");
  const scale = element("span", { className: "scale-in-view" });
  const bar = element("div", { className: "view-controls" }, play, slider, time,
    element("label", {}, "colour ", colours), element("label", {}, edges, " edges"), again, shut, scale,
    element("p", { className: "quiet" }, "Drag turns, Shift-drag or two fingers move, wheel or pinch zooms. Keys: arrows, Shift-arrows, "
      + "+ \u2212, space, comma and full stop for single frames, Home, Escape."
      + (scene.slowed > 1 ? ` Played ${scene.slowed} times slower than real time.` : "")));
  slider.setAttribute("aria-label", "time");
  play.addEventListener("click", () => { state.playing = !state.playing; changed(); });
  slider.addEventListener("input", () => { goTo(scene, state, Number(slider.value)); changed(); });
  colours.addEventListener("change", () => { state.field = Number(colours.value); showBar(figure, scene.fields[state.field]); changed(); });
  edges.addEventListener("change", () => { state.edges = edges.checked; changed(); });
  again.addEventListener("click", reset);
  shut.addEventListener("click", close);
  colours.value = state.field;
  showBar(figure, scene.fields[state.field]);
  const digits = Math.max(0, 2 - Math.floor(Math.log10(scene.times[scene.times.length - 1] || 1)));
  return {
    bar,
    show() {
      play.textContent = state.playing ? "Pause" : "Play";
      slider.value = state.frame;
      time.textContent = `${scene.times[state.frame].toFixed(digits)} s`;
    },
    showScale(metres, pixels) {
      const power = 10 ** Math.floor(Math.log10(0.25 * metres));
      const length = [5, 2, 1].map((step) => step * power).find((step) => step <= 0.25 * metres);
      const [factor, unit] = length >= 0.999 ? [1, "m"] : length >= 0.00999 ? [100, "cm"] : [1000, "mm"];
      scale.textContent = `${Number((length * factor).toPrecision(3))} ${unit}`;
      scale.style.setProperty("--length", `${length / metres * pixels}px`);
    },
    remove() { bar.remove(); showBar(figure, scene.fields.find((field) => field.name === figure.dataset.field)); },
  };
}

/** The colour bar of a field; none for the two sides. */
function showBar(figure, field) {
  const bar = figure.querySelector(".colour-bar");
  if (!bar) return;
  bar.hidden = !field;
  if (!field) return;
  bar.querySelector(".colours").className = `colours ${field.colours}`;
  bar.querySelectorAll(".ticks span").forEach((tick, k) => { tick.textContent = field.ticks[k]; });
  bar.querySelector(".of").textContent = field.unit ? `${field.label} [${field.unit}]` : field.label;
}

function element(tag, properties = {}, ...inside) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...inside);
  return made;
}
