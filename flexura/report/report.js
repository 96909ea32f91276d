"use strict";
// The report's player and read-outs. The motion comes as bends and stretches; all curves are computed from them.
(() => {
  const run = JSON.parse(document.getElementById("run").textContent);
  const sections = run.lengths.length;
  const perState = run.planar ? sections : 2 * sections;
  const first = run.times[0];
  const last = run.times[run.times.length - 1];
  const DEG = 180 / Math.PI;

  // --- the arm at a time -------------------------------------------------------------------------------------------

  /** Index of the last state at or before `time`, and how far (0 to 1) the time is on the way to the next one. */
  function place(time) {
    let low = 0;
    let high = run.times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (run.times[middle] <= time) low = middle;
      else high = middle;
    }
    const span = run.times[high] - run.times[low];
    return { index: low, part: span > 0 ? Math.min(Math.max((time - run.times[low]) / span, 0), 1) : 0 };
  }

  /** Number k of `width` a state in `values`, linear between states. */
  function between(values, width, { index, part }, k) {
    const a = values[index * width + k];
    return part > 0 ? a + (values[(index + 1) * width + k] - a) * part : a;
  }

  /** Each section's bend [x, y] in rad and its stretch. */
  function stateAt(time) {
    const at = place(time);
    const state = [];
    for (let i = 0; i < sections; ++i) {
      const x = between(run.bends, perState, at, run.planar ? i : 2 * i);
      const y = run.planar ? 0 : between(run.bends, perState, at, 2 * i + 1);
      const stretch = run.stretches.length > 0 ? between(run.stretches, sections, at, i) : 1;
      state.push({ x, y, stretch });
    }
    return state;
  }

  // --- constant-curvature kinematics -------------------------------------------------------------------------------

  const sinc = (t) => (Math.abs(t) < 1e-4 ? 1 - (t * t) / 6 : Math.sin(t) / t);

  /** u X + v Y + w Z, the frame's own axes in the world. */
  const along = (frame, u, v, w) =>
    [0, 1, 2].map((k) => frame.axes[k] * u + frame.axes[3 + k] * v + frame.axes[6 + k] * w);
  const minus = (p, q) => p.map((value, k) => value - q[k]);
  const plus = (p, q, factor) => p.map((value, k) => value + factor * q[k]);

  /** The frame at the end of an arc; (1 - cos t)/t^2 is written so that nothing cancels near t = 0. */
  function arcEnd(frame, x, y, length) {
    const theta = Math.hypot(x, y);
    const s = sinc(theta);
    const c = 0.5 * sinc(theta / 2) ** 2;
    return {
      axes: [
        ...along(frame, 1 - c * x * x, -c * x * y, -s * x),
        ...along(frame, -c * x * y, 1 - c * y * y, -s * y),
        ...along(frame, s * x, s * y, 1 - c * theta * theta),
      ],
      point: plus(frame.point, along(frame, c * x, c * y, s), length),
    };
  }

  const base = { axes: run.axes, point: run.origin };

  function tipOf(state) {
    let frame = base;
    state.forEach((q, i) => { frame = arcEnd(frame, q.x, q.y, run.lengths[i] * q.stretch); });
    return frame.point;
  }

  // --- drawing -----------------------------------------------------------------------------------------------------

  function add(parent, tag, attributes) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return parent.appendChild(element);
  }

  const thinnest = 2.5; // Half of a tube's width, page units.
  const border = 5; // Of a warning around a tube, page units.
  const gap = 1.8; // Between the two, for tubes as red as the border.
  const parts = run.lengths.map((_, section) => {
    const radii = run.radii.slice(2 * section, 2 * section + 2);
    return { section, radii, tapered: radii[0] !== radii[1] };
  });

  const views = [...document.querySelectorAll("#stage .view")].map((group) => {
    const scale = Number(group.dataset.scale);
    const across = group.dataset.view === "xoy" ? 0 : 2;
    const text = ([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`;
    const at = (p) => [Number(group.dataset.x) + scale * p[across], Number(group.dataset.y) - scale * p[1]];
    const page = (p) => text(at(p));
    const trail = run.times.map((time) => page(tipOf(stateAt(time))));
    add(group, "path", { class: "trail faint", d: `M${trail.join("L")}` });
    const around = (name, more) => parts.map((part) => add(group, "path", part.tapered ? { class: `${name}-taper` } : {
      class: `${name}-tube`, "stroke-width": 2 * (Math.max(part.radii[0] * scale, thinnest) + more),
    }));
    return {
      across, scale, at, text, page, trail,
      way: add(group, "path", { class: "trail" }),
      warnings: around("warning", border),
      gaps: around("gap", gap),
      tubes: parts.map((part) => add(group, "path", part.tapered ? { class: `taper s${part.section % 8}` } : {
        class: `tube s${part.section % 8}`, "stroke-width": 2 * Math.max(part.radii[0] * scale, thinnest),
      })),
      line: add(group, "path", { class: "spline" }),
      joints: group.dataset.joints === "no" ? [] : run.lengths.slice(1).map(() => add(group, "circle", { class: "joint", r: 2.8 })),
      tip: add(group, "circle", { class: "tip", r: 5 }),
    };
  });

  const moveTo = (circle, point) => {
    const [cx, cy] = point.split(" ");
    circle.setAttribute("cx", cx);
    circle.setAttribute("cy", cy);
  };

  /** Beziers of at most an eighth turn, tangent to the arc at both ends: one curve and every view of it. */
  function curve(frame, x, y, length, most = Math.PI / 4) {
    const theta = Math.hypot(x, y);
    const count = Math.floor(theta / most) + 1;
    const quarter = theta / count / 4;
    const handle = (length / count / 3) * (quarter < 1e-5 ? 1 : Math.tan(quarter) / quarter);
    const points = [frame.point];
    for (let i = 0; i < count; ++i) {
      const next = arcEnd(frame, x / count, y / count, length / count);
      points.push(plus(frame.point, frame.axes.slice(6), handle), plus(next.point, next.axes.slice(6), -handle), next.point);
      frame = next;
    }
    return points;
  }

  /** The outline of a tapered tube in a view, `more` page units wider than it is. */
  function outline(view, { radii }, frame, { x, y, length }, more) {
    const steps = 8 * (Math.floor(Math.hypot(x, y) / (Math.PI / 4)) + 1);
    const sides = [[], []];
    let normal = [1, 0];
    for (let i = 0; i <= steps; ++i) {
      const part = i / steps;
      const here = arcEnd(frame, part * x, part * y, part * length);
      const tangent = [here.axes[6 + view.across], -here.axes[7]];
      const size = Math.hypot(...tangent);
      if (size > 1e-6) normal = [-tangent[1] / size, tangent[0] / size];
      const half = [0, 1].map((k) => Math.max(radii[k] * view.scale, thinnest) + more);
      const reach = half[0] + (half[1] - half[0]) * part;
      const [u, v] = view.at(here.point);
      [1, -1].forEach((sign, k) => sides[k].push(view.text([u + sign * reach * normal[0], v + sign * reach * normal[1]])));
    }
    return `M${[...sides[0], ...sides[1].reverse()].join("L")}Z`;
  }

  /** The paper's Catmull-Rom spline (eq. 11) through `points`, past each end that end's neighbour reflected in it. */
  function spline(points) {
    const last = points.length - 1;
    const at = (i) => (i < 0 ? plus(points[0], minus(points[0], points[1]), 1)
      : i > last ? plus(points[last], minus(points[last], points[last - 1]), 1) : points[i]);
    const third = (i) => minus(at(i + 1), at(i - 1)).map((value) => (run.tension * value) / 3);
    return points.flatMap((point, i) => (i === 0 ? [point]
      : [plus(points[i - 1], third(i - 1), 1), plus(point, third(i), -1), point]));
  }

  /** The curve that is drawn along the arm, where it is not the arcs themselves. */
  function drawLine(state) {
    const frames = [base];
    state.forEach((q, i) => frames.push(arcEnd(frames[i], q.x, q.y, run.lengths[i] * q.stretch)));
    const points = run.curve === "catmull_rom" ? spline(frames.map((frame) => frame.point))
      : state.flatMap((q, i) => curve(frames[i], q.x, q.y, run.lengths[i] * q.stretch, Math.PI).slice(i > 0 ? 1 : 0));
    for (const view of views) {
      const [start, ...rest] = points.map(view.page);
      view.line.setAttribute("d", `M${start}C${rest.join(" ")}`);
    }
  }

  /** Puts nearer tubes over farther ones: the XOY view looks along -Z, the ZOY view along +X. */
  function stack(view, middles) {
    const nearness = (k) => (view.across === 0 ? middles[k][2] : -middles[k][0]);
    const order = parts.map((_, k) => k).sort((a, b) => nearness(a) - nearness(b) || a - b);
    if (String(order) === view.order) return;
    view.order = String(order);
    for (const k of order) view.tubes[k].parentNode.insertBefore(view.tubes[k], view.line);
  }

  function drawArm(time, state) {
    let frame = base;
    const unsafe = new Set(run.unsafe.filter(([start, end]) => start <= time && time <= end).map((found) => found[2]));
    const middles = [];
    parts.forEach((part, k) => {
      const q = { ...state[k], length: run.lengths[k] * state[k].stretch };
      if (k > 0) for (const view of views) if (view.joints.length > 0) moveTo(view.joints[k - 1], view.page(frame.point));
      middles.push(arcEnd(frame, q.x / 2, q.y / 2, q.length / 2).point);
      const points = curve(frame, q.x, q.y, q.length);
      for (const view of views) {
        const [start, ...rest] = points.map(view.page);
        const path = (more) => (part.tapered ? outline(view, part, frame, q, more) : `M${start}C${rest.join(" ")}`);
        view.tubes[k].setAttribute("d", path(0));
        view.warnings[k].setAttribute("d", unsafe.has(k) ? path(border) : "");
        view.gaps[k].setAttribute("d", unsafe.has(k) ? path(gap) : "");
      }
      frame = arcEnd(frame, q.x, q.y, q.length);
    });
    if (run.curve !== "arcs") drawLine(state);
    if (!run.planar) for (const view of views) stack(view, middles);
    const { index } = place(time);
    for (const view of views) {
      const here = view.page(frame.point);
      moveTo(view.tip, here);
      view.way.setAttribute("d", `M${[...view.trail.slice(0, index + 1), here].join("L")}`);
    }
    return frame.point;
  }

  // --- values ------------------------------------------------------------------------------------------------------

  const fixed = (value, decimals) => {
    const text = value.toFixed(decimals);
    return Number(text) === 0 ? text.replace("-", "") : text;
  };
  const clock = (time) => `t = ${fixed(time, 3)} s`;

  function cordAngles(state) {
    let tangent = run.baseAngle;
    return state.map((q) => {
      const arching = -q.x / 2;
      tangent += 2 * arching;
      return (tangent - arching) * DEG;
    });
  }

  /** What a chart or a column of the table shows, one number a section (or an axis). */
  const quantities = {
    "bends": { decimals: 2, of: (state) => state.map((q) => q.x * DEG) },
    "bends-x": { decimals: 2, of: (state) => state.map((q) => q.x * DEG) },
    "bends-y": { decimals: 2, of: (state) => state.map((q) => q.y * DEG) },
    "archings": { decimals: 2, of: (state) => state.map((q) => (-q.x / 2) * DEG) },
    "cord-angles": { decimals: 2, of: cordAngles },
    "stretches": { decimals: 4, of: (state) => state.map((q) => q.stretch) },
    "tip": { decimals: 3, of: tipOf },
  };

  const columns = Object.entries(quantities).map(([name, quantity]) => ({
    quantity, cells: [...document.querySelectorAll(`.values [data-value="${name}"]`)],
  })).filter((column) => column.cells.length > 0);

  // --- the player --------------------------------------------------------------------------------------------------

  const byId = (id) => document.getElementById(id);
  const player = byId("player");
  const scrub = byId("scrub");
  const play = byId("play");
  const speed = byId("speed");
  const loop = byId("loop");
  let now = first;
  let playing = false;
  let frameTime = null;

  function show(time) {
    now = Math.min(Math.max(time, first), last);
    const state = stateAt(now);
    const tip = drawArm(now, state);
    byId("time").textContent = clock(now);
    byId("tip").textContent = `E(${tip.slice(0, run.coordinates).map((value) => fixed(value, 3)).join(", ")})`;
    scrub.value = now;
    scrub.setAttribute("aria-valuetext", clock(now));
    for (const { quantity, cells } of columns) {
      const values = quantity.of(state);
      cells.forEach((cell, i) => { cell.textContent = fixed(values[i], quantity.decimals); });
    }
    for (const chart of charts) chart.mark(now);
  }

  function setPlaying(on) {
    playing = on && last > first;
    play.textContent = playing ? "Pause" : "Play";
    frameTime = null;
    if (!playing) return;
    if (now >= last) show(first);
    requestAnimationFrame(tick);
  }

  function tick(time) {
    if (!playing) return;
    // A page that was hidden goes on where it was.
    const elapsed = frameTime === null ? 0 : Math.min((time - frameTime) / 1000, 0.2);
    frameTime = time;
    const next = now + elapsed * Number(speed.value);
    if (next < last) {
      show(next);
    } else if (loop.checked) {
      show(first + ((next - first) % (last - first)));
    } else {
      show(last);
      setPlaying(false);
      return;
    }
    requestAnimationFrame(tick);
  }

  function jump(time) {
    setPlaying(false);
    show(time);
  }

  const step = (parts) => jump(now + (parts * (last - first)) / 100);

  function onKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target === speed) return;
    const onButton = event.target.matches("button, input[type=checkbox]");
    const far = event.shiftKey ? 10 : 1;
    if (event.key === " " && !onButton) setPlaying(!playing);
    else if (event.key === "ArrowRight") step(far);
    else if (event.key === "ArrowLeft") step(-far);
    else if (event.key === "Home") jump(first);
    else if (event.key === "End") jump(last);
    else return;
    event.preventDefault();
  }

  // --- read-outs in the charts -------------------------------------------------------------------------------------

  /** Series are named by their section's number, or by their axis. */
  const isSection = (name) => /^\d+$/.test(name);

  function readout(figure, chart) {
    const box = figure.appendChild(document.createElement("div"));
    box.className = "readout";
    box.hidden = true;
    const quantity = quantities[chart.dataset.chart];
    const names = chart.dataset.series.split(" ");
    box.classList.toggle("many", names.length > 12);
    return (time, x) => {
      const values = quantity.of(stateAt(time));
      const list = document.createElement("ul");
      names.forEach((name, i) => {
        const item = list.appendChild(document.createElement("li"));
        item.className = isSection(name) ? `s${(name - 1) % 8}` : `axis-${name}`;
        const label = document.createElement("span");
        label.textContent = name;
        const value = document.createElement("b");
        value.textContent = fixed(values[isSection(name) ? name - 1 : i], quantity.decimals);
        item.append(document.createElement("i"), label, value);
      });
      box.replaceChildren(clock(time), list);
      box.hidden = false;
      const room = figure.clientWidth - box.offsetWidth - 8;
      const left = x + 16 <= room ? x + 16 : x - 16 - box.offsetWidth;
      box.style.left = `${Math.min(Math.max(left, 8), Math.max(room, 8))}px`;
      return box;
    };
  }

  const charts = [...document.querySelectorAll(".chart")].map((chart) => {
    const [left, right, from, to] = ["left", "right", "from", "to"].map((name) => Number(chart.dataset[name]));
    const { top, bottom } = chart.dataset;
    const svg = chart.ownerSVGElement;
    const figure = svg.closest("figure");
    const cursor = add(chart, "path", { class: "cursor" });
    const tell = readout(figure, chart);
    const pageX = (time) => left + ((time - from) / (to - from)) * (right - left);
    const mark = (time) => cursor.setAttribute("d", `M${pageX(time).toFixed(2)} ${top}V${bottom}`);
    const onScreen = (x) => new DOMPoint(x, 0).matrixTransform(svg.getScreenCTM()).x - figure.getBoundingClientRect().left;
    const timeAt = (event) => {
      const { x } = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      return Math.min(Math.max(from + ((x - left) / (right - left)) * (to - from), first), last);
    };
    const hide = () => { figure.querySelector(".readout").hidden = true; mark(now); };
    const tellAt = (time) => { mark(time); tell(time, onScreen(pageX(time))); };
    svg.addEventListener("pointermove", (event) => tellAt(timeAt(event)));
    svg.addEventListener("pointerleave", hide);
    svg.addEventListener("click", (event) => jump(timeAt(event)));
    svg.setAttribute("tabindex", "0");
    svg.addEventListener("keydown", (event) => { onKey(event); if (event.defaultPrevented) tellAt(now); });
    svg.addEventListener("blur", hide);
    return { mark };
  });

  player.hidden = false;
  scrub.min = first;
  scrub.max = last;
  loop.checked = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  if (last <= first) for (const control of player.querySelectorAll("button, input, select")) control.disabled = true;
  play.addEventListener("click", () => setPlaying(!playing));
  byId("back").addEventListener("click", () => step(-1));
  byId("forward").addEventListener("click", () => step(1));
  byId("stage").addEventListener("click", () => setPlaying(!playing));
  scrub.addEventListener("input", () => jump(Number(scrub.value)));
  player.addEventListener("keydown", onKey);
  for (const button of document.querySelectorAll(".jump")) {
    button.addEventListener("click", () => { jump(Number(button.dataset.time)); player.scrollIntoView(); });
  }
  show(first);
})();
