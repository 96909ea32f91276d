"use strict";
// The report's view in three dimensions. The renderer is in space_draw.js.

/**
 * Starts the view. `run`: the motion. `around`: cameras, targets, obstacles and the true arm
 * (flexura/report/space.h). `sectionsAt(time)`: the commanded sections, each { points, radii }. `seek(time)`:
 * takes the page to a time. Returns {show(time)}; null without WebGL.
 */
const makeSpace = (run, around, sectionsAt, seek) => {
  const byId = (id) => document.getElementById(id);
  const room = byId("room");
  const canvas = byId("room-canvas");
  const gl = canvas.getContext("webgl2", { antialias: true, stencil: true, preserveDrawingBuffer: true });
  byId("space").hidden = false;
  if (gl === null) {
    byId("space-missing").hidden = false;
    byId("space-view").hidden = true;
    return null;
  }

  const { plus, dot, unit, across } = spaceVectors;
  const { newMesh, addTube, addCapsule, addQuad, addBox, addLine } = spaceMeshes;
  const { high, directions, projection } = spaceLook;
  const { start, clear, draw, outline, shadow } = spacePainter(gl);
  const span = run.lengths.reduce((sum, length) => sum + length, 0);
  const lineOf = (grains) => Array.from(
      { length: grains.length / 3 }, (_, i) => [0, 1, 2].map((k) => around.grain * grains[3 * i + k]));
  for (const target of around.targets) target.line &&= lineOf(target.line);
  for (const arm of around.truth) arm.line = lineOf(arm.line);
  const first = run.times[0];
  const last = run.times[run.times.length - 1];

  // --- what stands around the arm ------------------------------------------------------------------------------------

  const base = run.origin;
  const levelOf = ({ kind, point, normal }) => (kind === "plane" && normal[1] > 0.999 ? point[1] : -Infinity);
  const isStanding = run.axes[7] >= -1e-9;

  /**
   * As in the viewer (viewer/src/scene/floor_level.ts): a level plane not above the base, or one that is
   * only drawn.
   */
  function floorHeight() {
    const levels = around.obstacles.map(levelOf).filter(
        (level) => level <= base[1] + 1e-3 * span && level >= base[1] - 2.5 * span);
    if (levels.length > 0) return Math.max(...levels);
    if (isStanding) return base[1];
    return base[1] - 1.05 * span >= 0 && base[1] < 2.5 * span ? 0 : base[1] - 1.05 * span;
  }

  const floor = floorHeight();
  const rough = span / 8;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * power).find((size) => size >= rough * 0.999);
  const half = Math.ceil((1.5 * span) / step);
  const [gridX, gridZ] = [0, 2].map((k) => Math.round(base[k] / step) * step);
  const stepText = step >= 0.1 ? `${+ step.toPrecision(2)} m` : `${+ (step * 1000).toPrecision(2)} mm`;

  /** A camera's newest view at a time: its pupil and the corners of its picture. */
  function frustum({ views }, time) {
    const [, x, y, z, ...rest] = views.filter((view) => view[0] <= time).pop() ?? views[0];
    const axes = [rest.slice(0, 3), rest.slice(3, 6), rest.slice(6, 9)];
    const [left, right, top, bottom] = rest.slice(9);
    const pupil = [x, y, z];
    const far = Math.hypot(...plus(pupil, base, -1));
    const depth = Math.min(0.7 * far, Math.max(0.35 * far, (0.3 * span) / (right - left)));
    const corner = (u, v) => [u, v, 1].reduce((p, value, i) => plus(p, axes[i], depth * value), pupil);
    return [pupil, corner(left, top), corner(right, top), corner(right, bottom), corner(left, bottom)];
  }

  /** The target that the arm has at a time, and the true arm then; null without. */
  const targetAt = (time) =>
      around.targets
          .filter(({ start, end }) => (start < time || (start <= first && time <= first)) && time <= end + 1e-9)
          .pop() ??
      null;
  function truthAt(time) {
    const arms = around.truth;
    if (arms.length === 0) return null;
    const next = arms.findIndex((arm) => arm.time >= time);
    if (next === 0 || next < 0) return arms.at(next).line;
    const [a, b] = [arms[next - 1], arms[next]];
    const part = (time - a.time) / (b.time - a.time);
    return a.line.map((p, i) => plus(p.map((value) => (1 - part) * value), b.line[i], part));
  }

  /** Whether a line runs along the sections, as far as anybody sees. */
  const covers = (sections, line) => {
    const points = sections.flatMap((section) => section.points);
    const near = (p) => points.some((other) => Math.hypot(...plus(p, other, -1)) < 0.02 * span);
    const offTip = Math.hypot(...plus(line.at(-1), points.at(-1), -1));
    return offTip < 0.002 * span && line.every(near);
  };

  /** The tube's radius at a fraction of the arm's length. */
  function radiusAt(f) {
    let rest = f * span;
    let k = 0;
    while (k + 1 < run.lengths.length && rest > run.lengths[k]) rest -= run.lengths[k++];
    const part = Math.min(rest / run.lengths[k], 1);
    return thick(run.radii[2 * k] * (1 - part) + run.radii[2 * k + 1] * part);
  }
  const thick = (radius) => Math.max(radius, 0.002 * span);

  // --- colours -------------------------------------------------------------------------------------------------------

  let colors = {};
  function readColors() {
    const probe = room.appendChild(document.createElement("span"));
    const of = (name) => {
      probe.className = name;
      return getComputedStyle(probe).color.match(/[\d.]+/g).slice(0, 3).map((value) => Number(value) / 255);
    };
    const names = ["back", "plate", "line", "x", "y", "z", "base", "camera", "target", "truth", "warning"];
    colors = Object.fromEntries(names.map((name) => [name, of(`room-${name}`)]));
    colors.sections = run.lengths.map((_, k) => of(`s${k % 8}`));
    probe.remove();
  }

  // --- the viewpoint -------------------------------------------------------------------------------------------------

  const opening = { azimuth: 0.6, elevation: 0.34 };
  let eye = {...opening, distance: 3 * span, target: base};

  /** Looks at all points from the opening direction. Points of cameras that are too far away are left out. */
  function frame() {
    const aspect = canvas.width / canvas.height || 1.6;
    const { right, up, back } = directions(opening);
    const moments = Array.from({ length: 40 }, (_, i) => first + ((last - first) * i) / 39);
    const arm = moments.flatMap((time) => sectionsAt(time).flatMap(({ points }) => points));
    const must = [...arm, ...around.truth.flatMap(({ line }) => line), [base[0], floor, base[2]]];
    let may = around.cameras.flatMap((camera) => frustum(camera, last));
    for (;;) {
      // From the distance d along `back`, a point p is in the picture if |along p - middle| <= (d - back p) wide.
      const [x, y] = [[right, high * aspect * 0.94], [up, high * 0.9]].map(([along, wide]) => {
        const all = [...must, ...may];
        const most = all.reduce((value, p) => Math.max(value, dot(p, along) + dot(p, back) * wide), -Infinity);
        const least = all.reduce((value, p) => Math.min(value, dot(p, along) - dot(p, back) * wide), Infinity);
        return { middle: (most + least) / 2, distance: (most - least) / (2 * wide) };
      });
      const depth = dot(base, back);
      const distance = Math.max(x.distance, y.distance) - depth;
      if (distance <= 4.5 * span || may.length === 0) {
        const target = plus(plus(right.map((value) => x.middle * value), up, y.middle), back, depth);
        eye = { ...opening, distance: Math.max(distance, 0.5 * span), target };
        return;
      }
      const off = (p) => Math.hypot(...plus(p, base, -1));
      const farthest = Math.max(...may.map(off));
      may = may.filter((p) => off(p) < farthest);
    }
  }

  // --- a picture -----------------------------------------------------------------------------------------------------

  const wanted = { arm: true, truth: true, targets: true, cameras: true, floor: true };
  let now = last;
  let waiting = false;
  let inSight = true;

  function name(text, kind, p, view) {
    const [x, y, , w] =
        [0, 1, 2, 3].map((i) => view[i] * p[0] + view[4 + i] * p[1] + view[8 + i] * p[2] + view[12 + i]);
    const [left, top] = [(0.5 + x / (2 * w)) * room.clientWidth, (0.5 - y / (2 * w)) * room.clientHeight];
    if (w <= 0 || left < 8 || top < 8 || left > room.clientWidth - 8 || top > room.clientHeight - 8) return;
    const label = byId("room-names").appendChild(document.createElement("span"));
    label.textContent = text;
    label.className = kind;
    label.style.left = `${left.toFixed(1)}px`;
    label.style.top = `${top.toFixed(1)}px`;
  }

  function bodies() {
    const mesh = newMesh();
    for (const body of around.obstacles) {
      const color = body.color.map((value) => Math.min(1, Math.max(0, value)) ** (1 / 2.2));
      if (body.kind === "capsule") addCapsule(mesh, body.from, body.to, body.radius, color);
      if (body.kind === "box") addBox(mesh, body.center, body.axes, color);
      if (body.kind !== "plane" || levelOf(body) === floor) continue;
      const foot = plus(base, body.normal, dot(plus(body.point, base, -1), body.normal));
      const [u, v] = across(body.normal);
      addQuad(mesh, foot, u.map((value) => 0.8 * span * value), v.map((value) => 0.8 * span * value), color);
    }
    const z = run.axes.slice(6, 9);
    const size = 1.7 * thick(run.radii[0]);
    addTube(mesh, [plus(base, z, -0.9 * size), base], () => size, colors.base);
    return mesh;
  }

  function floorLines() {
    const mesh = newMesh();
    for (let i = -half; i <= half; ++i) {
      addLine(
          mesh, [gridX + i * step, floor, gridZ - half * step],
          [gridX + i * step, floor, gridZ + half * step], colors.line);
      addLine(
          mesh, [gridX - half * step, floor, gridZ + i * step],
          [gridX + half * step, floor, gridZ + i * step], colors.line);
    }
    return mesh;
  }

  function render() {
    waiting = false;
    if (gl.isContextLost()) return;
    const scale = Math.min(devicePixelRatio || 1, 2);
    const [width, height] =
        [room.clientWidth, room.clientHeight].map((size) => Math.max(1, Math.round(scale * size)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const { at, view } = projection(eye, width / height);
    clear(colors.back, view, at);
    byId("room-names").replaceChildren();
    const pixel = (2 * high) / height;  // At a depth of 1 m.

    const sections = sectionsAt(now);
    const tubes = sections.map(({ points, radii }, k) => {
      const mesh = newMesh();
      addTube(mesh, points, (f) => thick(radii[0] * (1 - f) + radii[1] * f), colors.sections[k]);
      return mesh;
    });
    const truth = truthAt(now);
    const target = targetAt(now);
    const isHidden = target !== null && target.line !== null && covers(sections, target.line);
    if (wanted.floor && at[1] > floor) {
      const plate = newMesh();
      addQuad(
          plate, [gridX, floor - 1e-3 * span, gridZ], [half * step, 0, 0], [0, 0, -half * step],
          colors.plate);
      draw(plate, { lit: false });
      if (wanted.arm) shadow(tubes, floor - 5e-4 * span);
    }
    if (wanted.floor) {
      draw(floorLines(), { lines: true });
      name(
          `squares of ${stepText}`, "size",
          [
            gridX + (Math.sin(eye.azimuth) > 0 ? 1 : -1) * 0.5 * half * step, floor,
            gridZ + (Math.cos(eye.azimuth) > 0 ? 1 : -1) * half * step * 0.5
          ],
          view);
    }
    draw(bodies());
    if (wanted.arm)
      for (const tube of tubes) draw(tube);
    if (wanted.arm)
      for (const [from, to, section] of run.unsafe)
        if (from <= now && now <= to) outline(tubes[section], colors.warning, 3.5 * scale * pixel);
    const ghost = (line, color) => {
      const mesh = newMesh();
      addTube(mesh, line, radiusAt, color);
      outline(mesh, color, 2 * scale * pixel);
    };
    if (truth && wanted.truth) ghost(truth, colors.truth);
    const lines = newMesh();
    if (target && wanted.targets) {
      if (target.line && !isHidden) ghost(target.line, colors.target);
      if (target.position)
        for (const axis of [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
          addLine(
              lines, plus(target.position, axis, -0.03 * span), plus(target.position, axis, 0.03 * span),
              colors.target);
    }
    if (wanted.cameras)
      for (const camera of around.cameras) {
        const [pupil, ...corners] = frustum(camera, now);
        corners.forEach((corner, i) => {
          addLine(lines, pupil, corner, colors.camera);
          addLine(lines, corner, corners[(i + 1) % 4], colors.camera);
        });
        name(camera.name, "camera", pupil, view);
      }
    [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]].forEach(([axis, way]) => {
      const from = plus(base, [0, wanted.floor ? 1e-3 * span : 0, 0]);
      addLine(lines, from, plus(from, way, 0.18 * span), colors[axis]);
      name(axis.toUpperCase(), axis, plus(from, way, 0.205 * span), view);
    });
    draw(lines, { lines: true });

    const tip = (wanted.arm || !truth ? sections.at(-1).points : truth).at(-1);
    byId("space-time").textContent = `t = ${now.toFixed(3)} s`;
    byId("space-state").textContent = target ? `target: ${target.name}${isHidden ? ", as commanded" : ""}` : "";
    room.dataset.tip = tip.map((value) => value.toFixed(4)).join(" ");
    room.dataset.view =
        [eye.azimuth, eye.elevation, eye.distance / span].map((value) => value.toFixed(4)).join(" ");
  }

  function request() {
    if (waiting || !inSight) return;
    waiting = true;
    requestAnimationFrame(render);
  }

  // --- what the user does --------------------------------------------------------------------------------------------

  const scrub = byId("space-scrub");
  function show(time) {
    now = Math.min(Math.max(time, first), last);
    const next = run.times.findIndex((each) => each > now + 1e-9);
    scrub.value = next < 0 ? run.times.length - 1 : Math.max(0, next - 1);
    scrub.setAttribute("aria-valuetext", `t = ${now.toFixed(3)} s`);
    request();
  }

  function turn(right, up) {
    eye.azimuth -= right;
    eye.elevation = Math.min(1.569, Math.max(-1.569, eye.elevation + up));
    request();
  }
  function move(x, y) {
    const { right, up } = directions(eye);
    const size = (2 * high * eye.distance) / room.clientHeight;
    eye.target = plus(plus(eye.target, right, -x * size), up, y * size);
    request();
  }
  function zoom(factor) {
    eye.distance = Math.min(30 * span, Math.max(0.02 * span, eye.distance * factor));
    request();
  }
  function reset() {
    frame();
    request();
  }

  const fingers = new Map();
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  room.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    room.setPointerCapture(event.pointerId);
  });
  room.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (before === undefined) return;
    const wide = fingers.size > 1 ? spread() : 0;
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    const [x, y] = [event.clientX - before[0], event.clientY - before[1]];
    if (fingers.size > 1)
      zoom(wide / Math.max(1, spread()));
    else if (event.shiftKey || event.buttons & 6)
      move(x, y);
    else
      turn(x * 0.008, y * 0.008);
  });
  for (const kind of ["pointerup", "pointercancel"])
    room.addEventListener(kind, (event) => fingers.delete(event.pointerId));
  room.addEventListener("contextmenu", (event) => event.preventDefault());
  room.addEventListener("wheel", (event) => {
    // Otherwise the page scrolls.
    if (!event.ctrlKey && document.activeElement !== room) return;
    event.preventDefault();
    zoom(Math.exp(Math.sign(event.deltaY) * 0.12));
  }, { passive: false });
  const keys = {
    ArrowLeft: () => turn(0.12, 0),
    ArrowRight: () => turn(-0.12, 0),
    ArrowUp: () => turn(0, 0.12),
    ArrowDown: () => turn(0, -0.12),
    "+": () => zoom(0.88),
    "=": () => zoom(0.88),
    "-": () => zoom(1 / 0.88),
    Home: reset,
  };
  room.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || !(event.key in keys)) return;
    keys[event.key]();
    event.preventDefault();
  });
  byId("space-reset").addEventListener("click", reset);
  scrub.max = run.times.length - 1;
  byId("space-slide").hidden = run.still;
  scrub.addEventListener("input", () => seek(run.times[Number(scrub.value)]));

  const choices = [
    ["arm", "arm as commanded", around.truth.length > 0],
    ["truth", "true arm", around.truth.length > 0],
    ["targets", "target", around.targets.length > 0],
    ["cameras", "cameras", around.cameras.length > 0],
    ["floor", "floor", true],
  ];
  for (const [key, text] of choices.filter(([, , isThere]) => isThere)) {
    const label = byId("space-shown").appendChild(document.createElement("label"));
    const box =
        label.appendChild(Object.assign(document.createElement("input"), { type: "checkbox", checked: true }));
    label.append(
        " ", Object.assign(document.createElement("span"), {textContent: text, className: `shown-${key}`}));
    box.addEventListener("change", () => {
      wanted[key] = box.checked;
      request();
    });
  }

  canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => {
    start();
    request();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    readColors();
    request();
  });
  new IntersectionObserver((entries) => {
    inSight = entries.at(-1).isIntersecting;
    request();
  }, { rootMargin: "200px" }).observe(room);
  addEventListener("beforeprint", render);
  start();
  readColors();
  let isFramed = false;
  new ResizeObserver(() => {
    if (!isFramed && room.clientHeight > 0) {
      isFramed = true;
      [canvas.width, canvas.height] = [room.clientWidth, room.clientHeight];
      frame();
    }
    request();
  }).observe(room);
  return { show };
};
