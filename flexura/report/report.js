"use strict";
// The report's player and its charts. Computes the arm from the motion's bends and stretches.
(() => {
  const byId = (id) => document.getElementById(id);
  const run = JSON.parse(byId("run").textContent);
  const sections = run.lengths.length;
  const first = run.times[0];
  const last = run.times[run.times.length - 1];

  // --- the arm at a time -------------------------------------------------------------------------------------------

  /** Returns the index of the last state at or before `time`, and the fraction (0 to 1) towards the next one. */
  function place(time) {
    let low = 0;
    let high = run.times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (run.times[middle] <= time) low = middle;
      else high = middle;
    }
    const span = run.times[high] - run.times[low];
    return { low, high, part: span > 0 ? Math.min(Math.max((time - run.times[low]) / span, 0), 1) : 0 };
  }

  /** Returns each section's bend [x, y] in rad and its length, linear between states. */
  function stateAt(time) {
    const { low, high, part } = place(time);
    const number = (k) => run.states[3 * sections * low + k] * (1 - part) + run.states[3 * sections * high + k] * part;
    return run.lengths.map((length, i) => ({ x: number(3 * i), y: number(3 * i + 1), length: length * number(3 * i + 2) }));
  }

  // --- constant-curvature kinematics -------------------------------------------------------------------------------

  const sinc = (t) => (Math.abs(t) < 1e-4 ? 1 - (t * t) / 6 : Math.sin(t) / t);

  /** Returns u X + v Y + w Z, with the frame's axes in the world. */
  const along = (frame, u, v, w) =>
    [0, 1, 2].map((k) => frame.axes[k] * u + frame.axes[3 + k] * v + frame.axes[6 + k] * w);

  /** Returns the frame after `part` of an arc. (1 - cos t)/t^2 is written to avoid cancellation near t = 0. */
  function arcEnd(frame, q, part = 1) {
    const [x, y] = [part * q.x, part * q.y];
    const theta = Math.hypot(x, y);
    const s = sinc(theta);
    const c = 0.5 * sinc(theta / 2) ** 2;
    const way = along(frame, c * x, c * y, s);
    return {
      axes: [
        ...along(frame, 1 - c * x * x, -c * x * y, -s * x),
        ...along(frame, -c * x * y, 1 - c * y * y, -s * y),
        ...along(frame, s * x, s * y, 1 - c * theta * theta),
      ],
      point: frame.point.map((value, k) => value + part * q.length * way[k]),
    };
  }

  const base = { axes: run.axes, point: run.origin };

  /** Returns the points along each section and the tube's radii at its ends. */
  function sectionsAt(time) {
    let frame = base;
    return stateAt(time).map((q, k) => {
      const start = frame;
      const steps = 16 * (Math.floor(Math.hypot(q.x, q.y) / (Math.PI / 2)) + 1);
      frame = arcEnd(start, q);
      const points = Array.from({ length: steps + 1 }, (_, i) => arcEnd(start, q, i / steps).point);
      return { points, radii: run.radii.slice(2 * k, 2 * k + 2) };
    });
  }
  const tipOf = (state) => state.reduce((frame, q) => arcEnd(frame, q), base).point;

  // --- drawing -----------------------------------------------------------------------------------------------------

  function add(parent, tag, attributes) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return parent.appendChild(element);
  }

  const thinnest = 2.5; // Half of a tube's width, page units.
  const border = 5; // Width of a warning around a tube, page units.
  const gap = 1.8; // Between tube and border, for tubes as red as the border.
  const path = (points) => `M${points.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join("L")}`;

  const views = [...document.querySelectorAll("#stage .view")].map((group) => {
    const scale = Number(group.dataset.scale);
    const across = group.dataset.view === "xoy" ? 0 : 2;
    const page = (p) => [Number(group.dataset.x) + scale * p[across], Number(group.dataset.y) - scale * p[1]];
    const trail = run.times.map((time) => page(tipOf(stateAt(time))));
    add(group, "path", { class: "trail faint", d: path(trail) });
    const forEach = (name) => run.lengths.map((_, k) => add(group, "path", { class: name(k) }));
    return {
      across, scale, page, trail,
      way: add(group, "path", { class: "trail" }),
      warnings: forEach(() => "warning"),
      gaps: forEach(() => "gap"),
      tubes: forEach((k) => `tube s${k % 8}`),
      joints: group.dataset.joints === "no" ? [] : run.lengths.slice(1).map(() => add(group, "circle", { class: "joint", r: 2.8 })),
      tip: add(group, "circle", { class: "tip", r: 5 }),
    };
  });

  const moveTo = (circle, [x, y]) => {
    circle.setAttribute("cx", x.toFixed(2));
    circle.setAttribute("cy", y.toFixed(2));
  };

  /** Returns the outline of section k's tube in a view, `more` page units wider than the tube. */
  function outline(view, k, frame, q, more) {
    const steps = 16 * (Math.floor(Math.hypot(q.x, q.y) / (Math.PI / 4)) + 1);
    const radii = run.radii.slice(2 * k, 2 * k + 2).map((radius) => Math.max(radius * view.scale, thinnest) + more);
    const sides = [[], []];
    let normal = [1, 0];
    for (let i = 0; i <= steps; ++i) {
      const here = arcEnd(frame, q, i / steps);
      const tangent = [here.axes[6 + view.across], -here.axes[7]];
      const size = Math.hypot(...tangent);
      if (size > 1e-6) normal = [-tangent[1] / size, tangent[0] / size];
      const reach = radii[0] + ((radii[1] - radii[0]) * i) / steps;
      const [u, v] = view.page(here.point);
      [1, -1].forEach((sign, side) => sides[side].push([u + sign * reach * normal[0], v + sign * reach * normal[1]]));
    }
    return `${path([...sides[0], ...sides[1].reverse()])}Z`;
  }

  /** Draws nearer tubes over farther ones: the XOY view looks along -Z, the ZOY view along +X. */
  function stack(view, middles) {
    const nearness = (k) => (view.across === 0 ? middles[k][2] : -middles[k][0]);
    const order = view.tubes.map((_, k) => k).sort((a, b) => nearness(a) - nearness(b) || a - b);
    if (String(order) === view.order) return;
    view.order = String(order);
    for (const k of order) view.tubes[k].parentNode.insertBefore(view.tubes[k], view.joints[0] ?? view.tip);
  }

  function drawArm(time) {
    let frame = base;
    const unsafe = new Set(run.unsafe.filter(([start, end]) => start <= time && time <= end).map((found) => found[2]));
    const middles = [];
    stateAt(time).forEach((q, k) => {
      middles.push(arcEnd(frame, q, 0.5).point);
      for (const view of views) {
        if (k > 0 && view.joints.length > 0) moveTo(view.joints[k - 1], view.page(frame.point));
        view.tubes[k].setAttribute("d", outline(view, k, frame, q, 0));
        view.warnings[k].setAttribute("d", unsafe.has(k) ? outline(view, k, frame, q, border) : "");
        view.gaps[k].setAttribute("d", unsafe.has(k) ? outline(view, k, frame, q, gap) : "");
      }
      frame = arcEnd(frame, q);
    });
    for (const view of views) {
      stack(view, middles);
      const here = view.page(frame.point);
      moveTo(view.tip, here);
      view.way.setAttribute("d", path([...view.trail.slice(0, place(time).low + 1), here]));
    }
    return frame.point;
  }

  // --- charts ------------------------------------------------------------------------------------------------------

  const fixed = (value, decimals) => value.toFixed(decimals).replace(/^-(?=[0.]*$)/, "");
  const shown = (_, value) => (value === null ? "" : String(Number(value.toPrecision(4))));
  const shownPower = (_, value) => (value === null ? "" : String(Number((10 ** value).toPrecision(3))));
  const color = (name) => () => getComputedStyle(document.body).getPropertyValue(name);
  let now = first;

  /** Returns the plot of a chart; its lines have the styles of the legend. */
  function plot(host) {
    const given = JSON.parse(host.querySelector("script").textContent);
    const data = [given.x ?? run.times];
    const series = [{ label: host.dataset.x, value: shown }];
    host.querySelectorAll("li").forEach((item, i) => {
      const look = getComputedStyle(item);
      const line = { label: item.textContent, stroke: () => look.color, width: 2, value: host.dataset.log ? shownPower : shown };
      const dash = look.strokeDasharray.split(",").map(parseFloat).filter((length) => length > 0);
      const [values, dots, rings] = given.series[i];
      const points = (name, more) => ({ ...line, label: `${line.label}, ${name}`, paths: () => null, points: { show: true, ...more } });
      data.push(values, ...[dots, rings].filter((some) => some.length > 0));
      series.push({ ...line, dash });
      if (dots.length > 0) series.push(points("dots", { size: 6, fill: line.stroke }));
      if (rings.length > 0) series.push(points("rings", { size: 10, fill: "transparent" }));
    });
    const axis = { stroke: color("--soft"), grid: { stroke: color("--edge"), width: 1 }, ticks: { show: false },
      values: (_, all) => all.map((value) => String(Number(value.toPrecision(6)))) };
    // A logarithmic axis has the numbers whose powers of ten are drawn.
    const powers = host.dataset.log ? { incrs: [0.5, 1, 2, 5, 10], values: (_, all) => all.map((value) => String(Number((10 ** value).toPrecision(2)))) } : {};
    const roomy = (_, low, high) => {
      const half = 0.55 * Math.max(high - low, Number(host.dataset.least));
      return [(low + high) / 2 - half, (low + high) / 2 + half];
    };
    const chart = new uPlot({
      width: host.clientWidth, height: 280, series,
      scales: { x: { time: false }, y: { range: roomy } },
      axes: [{ ...axis, label: host.dataset.x, size: 28, labelSize: 22 }, { ...axis, ...powers, label: host.dataset.y, size: 58, labelSize: 22 }],
      cursor: { y: false },
      legend: { markers: { dash: (_, i) => (series[i].dash?.length > 0 ? (series[i].dash[0] > 4 ? "dashed" : "dotted") : "solid") } },
      hooks: { drawAxes: [({ ctx, bbox, valToPos }) => {
        ctx.fillStyle = color("--soft")();
        for (const x of given.marks.map((mark) => valToPos(mark, "x", true)))
          if (x >= bbox.left && x <= bbox.left + bbox.width) ctx.fillRect(x, bbox.top, 1, bbox.height);
      }] },
    }, data, host);
    new ResizeObserver(() => chart.setSize({ width: host.clientWidth, height: 280 })).observe(host);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => chart.redraw());
    if (given.x !== null) return null;
    const mark = () => {
      const left = chart.valToPos(now, "x");
      chart.setCursor({ left: left <= chart.over.clientWidth ? left : -10, top: 0 });
    };
    chart.over.addEventListener("click", () => jump(chart.posToVal(chart.cursor.left, "x")));
    chart.over.addEventListener("mouseleave", mark);
    host.tabIndex = 0;
    host.addEventListener("keydown", onKey);
    return { mark, y: host.dataset.y, isOfSections: host.dataset.legend === "section", series, data };
  }

  /** Makes the player's table of the charts' values per section; returns a function that fills it in. */
  function table(charts) {
    const row = (parent, tag, texts) => {
      const cells = texts.map((text) => Object.assign(document.createElement(tag), { textContent: text }));
      parent.insertRow().append(...cells);
      return cells;
    };
    row(byId("values").createTHead(), "th", ["section", ...charts.map((chart) => chart.y)]);
    const body = byId("values").createTBody();
    if (charts.length === 0) return () => {};
    const rows = charts[0].series.slice(1).map((line) => row(body, "td", [line.label, ...charts]));
    return () => {
      const { low, high, part } = place(now);
      rows.forEach((cells, i) => charts.forEach(({ data }, k) => {
        cells[k + 1].textContent = fixed(data[i + 1][low] * (1 - part) + data[i + 1][high] * part, 3);
      }));
    };
  }

  // --- the player --------------------------------------------------------------------------------------------------

  const [player, scrub, play, speed, loop] = ["player", "scrub", "play", "speed", "loop"].map(byId);
  const clock = (time) => `t = ${fixed(time, 3)} s`;
  let playing = false;
  let frameTime = null;

  function show(time) {
    now = Math.min(Math.max(time, first), last);
    const tip = drawArm(now);
    byId("time").textContent = clock(now);
    byId("tip").textContent = `E(${tip.slice(0, run.coordinates).map((value) => fixed(value, 3)).join(", ")})`;
    scrub.value = now;
    scrub.setAttribute("aria-valuetext", clock(now));
    fillTable();
    for (const chart of charts) chart.mark();
    space?.show(now);
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
    // A page that was hidden continues at its previous time.
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

  player.hidden = run.still;
  const space = makeSpace(run, JSON.parse(byId("around").textContent), sectionsAt, jump);
  const charts = [...document.querySelectorAll(".chart")].map(plot).filter((chart) => chart !== null);
  const fillTable = table(charts.filter((chart) => chart.isOfSections));
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
  // The drawings begin at the start, the view in three dimensions at the end.
  space?.show(last);
})();
