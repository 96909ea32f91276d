"use strict";
// A small renderer of tubes, bodies and lines on WebGL 2, for the report's view in three dimensions (space.js).

/** Vectors of three numbers. */
const spaceVectors = (() => {
  const plus = (a, b, f = 1) => [a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => {
    const size = Math.hypot(...a) || 1;
    return [a[0] / size, a[1] / size, a[2] / size];
  };
  /** Returns two unit vectors across a unit vector and each other. */
  const across = (n) => {
    const u = unit(cross(n, Math.abs(n[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]));
    return [u, cross(n, u)];
  };

  return { plus, dot, cross, unit, across };
})();

/** Meshes: position, normal and colour of each vertex. */
const spaceMeshes = (() => {
  const { plus, cross, dot, unit, across } = spaceVectors;
  const newMesh = () => ({ vertices: [], indices: [] });
  const put = (mesh, p, n, c) => {
    mesh.vertices.push(...p, ...n, ...c);
    return mesh.vertices.length / 9 - 1;
  };
  const sides = 20;

  /** Adds a tube along points. `radiusAt(f)`: at the fraction f of the points. */
  function addTube(mesh, points, radiusAt, color) {
    let [u] = across(unit(plus(points[1], points[0], -1)));
    const end = points.length - 1;
    let before = 0;
    points.forEach((p, i) => {
      const t = unit(plus(points[Math.min(i + 1, end)], points[Math.max(i - 1, 0)], -1));
      u = unit(plus(u, t, -dot(u, t)));
      const v = cross(t, u);
      const ring = mesh.vertices.length / 9;
      for (let k = 0; k <= sides; ++k) {
        const angle = (2 * Math.PI * k) / sides;
        const n = plus(u.map((value) => Math.cos(angle) * value), v, Math.sin(angle));
        put(mesh, plus(p, n, radiusAt(i / end)), n, color);
        if (i > 0 && k > 0)
          mesh.indices.push(before + k - 1, before + k, ring + k - 1, ring + k - 1, before + k, ring + k);
      }
      if (i === 0 || i === end)
        addDisk(mesh, p, i === 0 ? t.map((value) => -value) : t, radiusAt(i / end), color);
      before = ring;
    });
  }

  function addDisk(mesh, p, n, radius, color) {
    const [u, v] = across(n);
    const middle = put(mesh, p, n, color);
    for (let k = 0; k <= sides; ++k) {
      const angle = (2 * Math.PI * k) / sides;
      put(mesh, plus(plus(p, u, radius * Math.cos(angle)), v, radius * Math.sin(angle)), n, color);
      if (k > 0) mesh.indices.push(middle, middle + k, middle + k + 1);
    }
  }

  /** Adds everything within a radius of a line: circles of latitude around its axis. */
  function addCapsule(mesh, from, to, radius, color) {
    const n = Math.hypot(...plus(to, from, -1)) > 0 ? unit(plus(to, from, -1)) : [0, 1, 0];
    const [u, v] = across(n);
    const rings = 12;
    let before = 0;
    for (let i = 0; i <= 2 * rings + 1; ++i) {
      const up = i > rings;
      const angle = ((i - rings - (up ? 1 : 0)) * Math.PI) / (2 * rings);
      const ring = mesh.vertices.length / 9;
      for (let k = 0; k <= sides; ++k) {
        const turn = (2 * Math.PI * k) / sides;
        const out = plus(u.map((value) => Math.cos(turn) * value), v, Math.sin(turn));
        const normal = plus(out.map((value) => Math.cos(angle) * value), n, Math.sin(angle));
        put(mesh, plus(up ? to : from, normal, radius), normal, color);
        if (i > 0 && k > 0)
          mesh.indices.push(before + k - 1, before + k, ring + k - 1, ring + k - 1, before + k, ring + k);
      }
      before = ring;
    }
  }

  function addQuad(mesh, middle, a, b, color) {
    const n = unit(cross(a, b));
    const at = mesh.vertices.length / 9;
    for (const [i, j] of [[-1, -1], [1, -1], [-1, 1], [1, 1]])
      put(mesh, plus(plus(middle, a, i), b, j), n, color);
    mesh.indices.push(at, at + 1, at + 2, at + 2, at + 1, at + 3);
  }

  function addBox(mesh, center, axes, color) {
    for (let i = 0; i < 3; ++i)
      for (const side of [-1, 1])
        addQuad(mesh, plus(center, axes[i], side), axes[(i + 1) % 3], axes[(i + 2) % 3], color);
  }

  const addLine = (mesh, a, b, color) =>
      mesh.indices.push(put(mesh, a, [0, 0, 0], color), put(mesh, b, [0, 0, 0], color));

  return { newMesh, addTube, addCapsule, addQuad, addBox, addLine };
})();

/** Viewpoints: a target, a distance, and two angles as in the viewer. */
const spaceLook = (() => {
  const { plus, dot } = spaceVectors;
  /** Tangent of half the field of view. */
  const high = Math.tan((19 * Math.PI) / 180);

  const directions = ({ azimuth, elevation }) => {
    const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
    return { right: [ca, 0, -sa], up: [-se * sa, ce, -se * ca], back: [ce * sa, se, ce * ca] };
  };

  /** Returns the eye's position `at` and the projection onto a picture of this width over height. */
  function projection(eye, aspect) {
    const { right, up, back } = directions(eye);
    const at = plus(eye.target, back, eye.distance);
    const [near, far] = [eye.distance / 100, eye.distance * 60];
    const rows = [
      right.map((v) => v / (high * aspect)), up.map((v) => v / high),
      back.map((v) => (v * -(far + near)) / (far - near)), back.map((v) => -v)
    ];
    const shifts = rows.map((row) => -dot(row, at));
    shifts[2] = -dot(rows[2], at) - (2 * far * near) / (far - near);
    const view = new Float32Array(16);
    rows.forEach((row, i) => [...row, shifts[i]].forEach((value, k) => {
      view[4 * k + i] = value;
    }));
    return { at, view };
  }

  return { high, directions, projection };
})();

/** Returns what draws meshes on a canvas. `start`: also after a loss of the context. */
const spacePainter = (gl) => {
  let program = null;
  let places = {};
  function start() {
    const shader = (kind, text) => {
      const made = gl.createShader(kind);
      gl.shaderSource(made, `#version 300 es\nprecision highp float;\n${text}`);
      gl.compileShader(made);
      return made;
    };
    program = gl.createProgram();
    gl.attachShader(program, shader(gl.VERTEX_SHADER, `
      layout(location = 0) in vec3 at; layout(location = 1) in vec3 normal; layout(location = 2) in vec3 color;
      uniform mat4 view; uniform float swell, level;
      out vec3 p, n, c;
      void main() {
        p = at; n = normal; c = color;
        if (level > -1e30) p.y = level;
        p += normal * swell * (view * vec4(p, 1.0)).w;
        gl_Position = view * vec4(p, 1.0);
      }`));
    gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `
      uniform vec3 eye; uniform float lit; uniform vec4 paint;
      in vec3 p, n, c;
      out vec4 shown;
      void main() {
        vec3 own = c;
        if (lit > 0.5) {
          vec3 m = normalize(n), towards = normalize(eye - p);
          if (dot(m, towards) < 0.0) m = -m;
          float facing = dot(m, towards);
          own = c * (0.42 + 0.46 * facing + 0.16 * max(m.y, 0.0)) + 0.12 * pow(facing, 24.0);
        }
        shown = paint.a > 0.0 ? paint : vec4(own, 1.0);
      }`));
    gl.linkProgram(program);
    gl.useProgram(program);
    places = Object.fromEntries(["view", "swell", "level", "eye", "lit", "paint"].map(
        (name) => [name, gl.getUniformLocation(program, name)]));
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    for (let i = 0; i < 3; ++i) {
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 36, 12 * i);
    }
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  const nowhere = -2e30;
  /** Draws a mesh. `paint`: one colour for all, with its opacity. */
  function draw(
      mesh,
      { lines = false, lit = !lines, swell = 0, level = nowhere, paint = [0, 0, 0, 0], again = false } = {}) {
    if (mesh.indices.length === 0) return;
    if (!again) {
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(mesh.vertices), gl.STREAM_DRAW);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(mesh.indices), gl.STREAM_DRAW);
    }
    gl.uniform1f(places.swell, swell);
    gl.uniform1f(places.level, level);
    gl.uniform1f(places.lit, lit ? 1 : 0);
    gl.uniform4fv(places.paint, paint);
    gl.drawElements(lines ? gl.LINES : gl.TRIANGLES, mesh.indices.length, gl.UNSIGNED_INT, 0);
  }

  /** Draws the outline of a mesh around its picture: where the widened mesh is, and the mesh is not. */
  function outline(mesh, color, swell) {
    gl.clear(gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.STENCIL_TEST);
    gl.stencilFunc(gl.ALWAYS, 1, 1);
    gl.stencilOp(gl.KEEP, gl.REPLACE, gl.REPLACE);
    gl.disable(gl.DEPTH_TEST);
    gl.colorMask(false, false, false, false);
    draw(mesh);
    gl.colorMask(true, true, true, true);
    gl.enable(gl.DEPTH_TEST);
    gl.stencilFunc(gl.NOTEQUAL, 1, 1);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    draw(mesh, { swell, lit: false, paint: [...color, 1], again: true });
    gl.disable(gl.STENCIL_TEST);
  }

  /** Draws the shadow straight below meshes: each point of the floor is darkened once. */
  function shadow(meshes, height) {
    gl.clear(gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.STENCIL_TEST);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    gl.stencilFunc(gl.NOTEQUAL, 1, 1);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.REPLACE);
    for (const mesh of meshes) draw(mesh, { level: height, lit: false, paint: [0, 0, 0, 0.16] });
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.disable(gl.STENCIL_TEST);
  }

  /** Starts a picture from `eye` with a projection `view`. */
  function clear(back, view, eye) {
    gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
    gl.clearColor(...back, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.uniformMatrix4fv(places.view, false, view);
    gl.uniform3fv(places.eye, eye);
  }

  return { start, clear, draw, outline, shadow };
};
