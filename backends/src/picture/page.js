"use strict";
(function () {
  // ---- data -------------------------------------------------------------------------------
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const bytes = function (text) {
    const raw = atob(text), out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
    return out.buffer;
  };
  // Numbers are little-endian in the page, whatever the machine.
  const numbers = function (text, float) {
    const view = new DataView(bytes(text)), n = view.byteLength / 4;
    const out = float ? new Float32Array(n) : new Uint32Array(n);
    for (let i = 0; i < n; i++) out[i] = float ? view.getFloat32(4 * i, true) : view.getUint32(4 * i, true);
    return out;
  };
  const triangles = numbers(scene.triangles, false);
  const pieceOf = numbers(scene.triangle_piece, false);
  const curves = scene.curves.map(function (c) {
    return { name: c.name, color: c.color, wide: c.wide, edges: numbers(c.edges, false) };
  });
  const layouts = scene.layouts.map(function (l) {
    return { name: l.name, places: numbers(l.places, true), points: numbers(l.points, true) };
  });
  const count = triangles.length / 3;
  // Rows of the input: of vertices (-1 for none), and of sample points, where they are not all shown.
  const vertexRows = new Int32Array(numbers(scene.vertex_rows, false).buffer), pointRows = numbers(scene.point_rows, false);
  const scalars = scene.scalars.map(function (s) {
    const out = { name: s.name, vertices: numbers(s.vertices, true), points: numbers(s.points, true), low: Infinity, high: -Infinity };
    [out.vertices, out.points].forEach(function (list) {
      list.forEach(function (x) { if (isFinite(x)) { out.low = Math.min(out.low, x); out.high = Math.max(out.high, x); } });
    });
    return out;
  });
  const edgeKey = function (a, b) { return a < b ? a * 4294967296 + b : b * 4294967296 + a; };
  const onCurve = new Set();
  curves.forEach(function (c) {
    for (let i = 0; i < c.edges.length; i += 2) onCurve.add(edgeKey(c.edges[i], c.edges[i + 1]));
  });
  // Edges of triangles with the pieces that they belong to (the first one counts).
  const meshEdges = [];
  (function () {
    const seen = new Set();
    for (let t = 0; t < count; t++) for (let k = 0; k < 3; k++) {
      const a = triangles[3 * t + k], b = triangles[3 * t + (k + 1) % 3];
      const key = edgeKey(a, b);
      if (!seen.has(key)) { seen.add(key); meshEdges.push(a, b, pieceOf[t]); }
    }
  })();

  // ---- state ------------------------------------------------------------------------------
  const state = {
    layout: 0, zoom: 1, pan: [0, 0], smooth: true, edges: false, points: count === 0 && curves.length === 0,
    curves: curves.map(function () { return true; }), pieces: scene.pieces.map(function () { return true; }),
    opacity: 1, keep: 1, axis: "view", spin: false, width: 1,
    // Which scalar colors the mesh, -1 for the pieces; what was picked, in the layout.
    color: -1, picked: null, marks: true
  };
  let turn = [0, 0, 0, 1];
  const DISTANCE = 5;
  const home = function () { turn = layouts[state.layout].home || [0, 0, 0, 1]; state.zoom = 1; state.pan = [0, 0]; };

  // ---- small algebra ----------------------------------------------------------------------
  const cross = function (a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; };
  const unit = function (a) { const l = Math.hypot(a[0], a[1], a[2]) || 1; return [a[0] / l, a[1] / l, a[2] / l]; };
  const times = function (p, q) {
    return [
      p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1], p[3] * q[1] - p[0] * q[2] + p[1] * q[3] + p[2] * q[0],
      p[3] * q[2] + p[0] * q[1] - p[1] * q[0] + p[2] * q[3], p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2]];
  };
  const about = function (axis, angle) {
    const s = Math.sin(angle / 2), u = unit(axis);
    return [u[0] * s, u[1] * s, u[2] * s, Math.cos(angle / 2)];
  };
  // Rows of the rotation: right, up, towards the viewer.
  const matrix = function (q) {
    const l = Math.hypot(q[0], q[1], q[2], q[3]) || 1, x = q[0] / l, y = q[1] / l, z = q[2] / l, w = q[3] / l;
    return [
      1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)];
  };
  const fromRows = function (m) {
    const t = m[0] + m[4] + m[8];
    if (t > 0) { const s = 2 * Math.sqrt(t + 1); return [(m[7] - m[5]) / s, (m[2] - m[6]) / s, (m[3] - m[1]) / s, s / 4]; }
    if (m[0] > m[4] && m[0] > m[8]) { const s = 2 * Math.sqrt(1 + m[0] - m[4] - m[8]); return [s / 4, (m[1] + m[3]) / s, (m[2] + m[6]) / s, (m[7] - m[5]) / s]; }
    if (m[4] > m[8]) { const s = 2 * Math.sqrt(1 + m[4] - m[0] - m[8]); return [(m[1] + m[3]) / s, s / 4, (m[5] + m[7]) / s, (m[2] - m[6]) / s]; }
    const s = 2 * Math.sqrt(1 + m[8] - m[0] - m[4]); return [(m[2] + m[6]) / s, (m[5] + m[7]) / s, s / 4, (m[3] - m[1]) / s];
  };

  // ---- colors -----------------------------------------------------------------------------
  // From low to high, even in lightness: five places of the map viridis.
  const STOPS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  const UNKNOWN = [150, 150, 150], MARK = [214, 32, 32];
  const shade = function (scalar, x) {
    if (!isFinite(x)) return UNKNOWN;
    const t = scalar.high > scalar.low ? 4 * (x - scalar.low) / (scalar.high - scalar.low) : 2;
    const k = Math.min(3, Math.floor(t)), f = t - k;
    return STOPS[k].map(function (c, i) { return Math.round(c + f * (STOPS[k + 1][i] - c)); });
  };
  const scalar = function (on) {
    const s = state.color < 0 ? null : scalars[state.color];
    return s && s[on].length ? s : null;
  };
  const vertexColor = function (t, v) {
    const s = scalar("vertices");
    return s ? shade(s, s.vertices[v]) : scene.pieces[pieceOf[t]].color;
  };
  const dotColor = function (i, own) {
    const s = scalar(own ? "vertices" : "points");
    return s ? shade(s, s[own ? "vertices" : "points"][i]) : dark() ? [204, 204, 204] : [72, 72, 76];
  };

  // ---- geometry of a layout, made when it is first shown ------------------------------------
  const prepare = function (layout, index) {
    if (layout.ready) return;
    layout.ready = true;
    const frame = scene.layouts[index].frame, P = layout.places, scaled = function (list) {
      const out = new Float32Array(list.length);
      for (let i = 0; i < list.length; i++) out[i] = Math.max(-1e4, Math.min(1e4, (list[i] - frame[i % 3]) / frame[3]));
      return out;
    };
    const at = layout.at = scaled(P);
    layout.dots = layout.points.length ? scaled(layout.points) : at;
    layout.marks = scaled(numbers(scene.layouts[index].marks, true));
    layout.home = fromRows(scene.layouts[index].view);
    let reach = 0;
    const all = at.length ? at : layout.dots;
    for (let i = 0; i < all.length; i += 3) reach = Math.max(reach, Math.hypot(all[i], all[i + 1], all[i + 2]));
    layout.reach = Math.min(1.8, reach || 1);
    // Normals of triangles, then of corners over the triangles that hang together around a vertex.
    const area = new Float32Array(3 * count), flat = layout.flat = new Float32Array(3 * count);
    const around = [];
    for (let t = 0; t < count; t++) {
      const i = 3 * triangles[3 * t], j = 3 * triangles[3 * t + 1], k = 3 * triangles[3 * t + 2];
      const n = cross([at[j] - at[i], at[j + 1] - at[i + 1], at[j + 2] - at[i + 2]], [at[k] - at[i], at[k + 1] - at[i + 1], at[k + 2] - at[i + 2]]);
      const u = unit(n);
      for (let c = 0; c < 3; c++) {
        area[3 * t + c] = n[c]; flat[3 * t + c] = u[c];
        const v = triangles[3 * t + c];
        (around[v] = around[v] || []).push(3 * t + c);
      }
    }
    const corner = layout.corner = new Float32Array(9 * count);
    for (let t = 0; t < 3 * count; t++) for (let c = 0; c < 3; c++) corner[3 * t + c] = flat[3 * Math.floor(t / 3) + c];
    around.forEach(function (fan, v) {
      if (fan.length > 64) return;
      const group = fan.map(function (_, i) { return i; });
      const others = fan.map(function (f) { const t = f - f % 3; return [triangles[t], triangles[t + 1], triangles[t + 2]].filter(function (w) { return w !== v; }); });
      for (let i = 0; i < fan.length; i++) for (let j = 0; j < i; j++) {
        const linked = others[i].some(function (w) { return others[j].indexOf(w) >= 0 && !onCurve.has(edgeKey(v, w)); });
        if (linked && group[i] !== group[j]) {
          const from = group[i], to = group[j];
          for (let k = 0; k < group.length; k++) if (group[k] === from) group[k] = to;
        }
      }
      for (let i = 0; i < fan.length; i++) {
        const s = 3 * Math.floor(fan[i] / 3), sum = [0, 0, 0];
        for (let j = 0; j < fan.length; j++) {
          if (group[i] !== group[j]) continue;
          const o = 3 * Math.floor(fan[j] / 3), d = flat[s] * flat[o] + flat[s + 1] * flat[o + 1] + flat[s + 2] * flat[o + 2];
          if (Math.abs(d) > 0.5) for (let c = 0; c < 3; c++) sum[c] += Math.sign(d) * area[o + c];
        }
        if (sum[0] || sum[1] || sum[2]) { const u = unit(sum); for (let c = 0; c < 3; c++) corner[3 * fan[i] + c] = u[c]; }
      }
    });
  };

  // ---- what both painters share --------------------------------------------------------------
  const canvas = document.getElementById("view");
  const dark = function () { return document.documentElement.dataset.theme === "dark"; };
  const ground = function () { return dark() ? [23, 25, 29] : [255, 255, 255]; };
  // Curves have to stand out from a dark ground too, where no surface lies behind them.
  const ink = function (c) { return dark() && state.opacity < 0.35 ? c.map(function (x) { return Math.round(x * 0.5 + 110); }) : c; };
  const camera = function () {
    const w = canvas.width, h = canvas.height, folded = document.body.classList.contains("folded");
    const ratio = w / Math.max(1, canvas.clientWidth), small = window.innerWidth <= 640;
    const side = folded || small ? 0 : 310 * ratio, below = !folded && small ? 0.42 * h : 0;
    const free = [Math.max(w - side, 0.3 * w), Math.max(h - below, 0.3 * h)];
    const reach = layouts[state.layout].reach, focal = 0.46 * Math.min(free[0], free[1]) * state.zoom * Math.sqrt(DISTANCE * DISTANCE - reach * reach) / reach;
    return { w: w, h: h, ratio: ratio, focal: focal, middle: [free[0] / 2 + state.pan[0] * ratio, free[1] / 2 + state.pan[1] * ratio], m: matrix(turn) };
  };
  // The cut as a normal in the layout and a limit; beyond it nothing is drawn.
  const cut = function (m) {
    const reach = layouts[state.layout].reach;
    const n = state.axis === "view" ? [m[6], m[7], m[8]] : [state.axis === "x" ? 1 : 0, state.axis === "y" ? 1 : 0, state.axis === "z" ? 1 : 0];
    return n.concat([state.keep >= 1 ? 1e9 : (2 * state.keep - 1) * reach * 1.001]);
  };
  // Places on the canvas: x, y, distance from the viewer, whether it is in sight.
  const project = function (list, cam, plane) {
    const n = list.length / 3, out = new Float32Array(4 * n), m = cam.m;
    for (let i = 0; i < n; i++) {
      const x = list[3 * i], y = list[3 * i + 1], z = list[3 * i + 2], d = DISTANCE - (m[6] * x + m[7] * y + m[8] * z);
      out[4 * i] = cam.middle[0] + cam.focal * (m[0] * x + m[1] * y + m[2] * z) / d;
      out[4 * i + 1] = cam.middle[1] - cam.focal * (m[3] * x + m[4] * y + m[5] * z) / d;
      out[4 * i + 2] = d;
      out[4 * i + 3] = d > 0.2 && plane[0] * x + plane[1] * y + plane[2] * z <= plane[3] ? 1 : 0;
    }
    return out;
  };
  const curveWidth = function (c, cam) { return state.width * (c.wide ? 5.2 : 4) * cam.ratio; };

  // Marks, and what was picked: drawn over everything.
  const MARK_SIZE = 9;
  const shownMarks = function (layout) {
    const marks = state.marks ? Array.from(layout.marks) : [];
    return state.picked && state.picked.layout === state.layout ? marks.concat(state.picked.at) : marks;
  };

  // ---- painter 1: WebGL ------------------------------------------------------------------------
  const webgl = function () {
    // Asked of another canvas first: one that has given a WebGL context gives no plain one any more.
    const probe = document.createElement("canvas").getContext("webgl");
    if (!probe || !probe.getExtension("OES_element_index_uint")) return null;
    const gl = canvas.getContext("webgl", { antialias: true, alpha: false, preserveDrawingBuffer: false });
    if (!gl || !gl.getExtension("OES_element_index_uint")) return null;
    const common =
      "uniform vec3 R, U, T; uniform vec4 lens;\n" +
      "vec3 eyes(vec3 p) { return vec3(dot(R, p), dot(U, p), dot(T, p)); }\n" +
      "vec4 screen(vec3 e) { float d = " + DISTANCE + ".0 - e.z;\n" +
      "  return vec4(e.x * lens.x + lens.z * d, e.y * lens.y + lens.w * d, d * 1.0513 - 2.0513, d); }\n";
    const light =
      "precision highp float; varying vec3 e, n, p; varying vec3 c; uniform vec4 plane; uniform float alpha, rimWidth;\n" +
      "void main() {\n" +
      "  float beyond = dot(p, plane.xyz) - plane.w; if (beyond > 0.0) discard;\n" +
      "  vec3 v = normalize(vec3(-e.xy, " + DISTANCE + ".0 - e.z)); vec3 m = length(n) > 0.0 ? normalize(n) : v;\n" +
      "  float f = dot(m, v); if (f < 0.0) { m = -m; f = -f; }\n" +
      "  vec3 k = vec3(-0.4137, 0.5976, 0.6870);\n" +
      "  float d = 0.40 + 0.60 * max(0.0, dot(m, k)) + 0.14 * max(0.0, dot(m, vec3(0.8137, -0.1162, 0.5695)));\n" +
      "  float s = 0.16 * pow(max(0.0, dot(m, normalize(k + v))), 36.0);\n" +
      "  vec3 o = c * d * (1.0 - 0.5 * pow(1.0 - f, 3.0)) + s;\n" +
      "  if (beyond > -rimWidth) o *= 0.4;\n" +
      "  float a = alpha < 1.0 ? 1.0 - pow(1.0 - alpha, 1.0 / max(f, 0.12)) : 1.0;\n" +
      "  gl_FragColor = vec4(o, a); }";
    const plain = "precision highp float; varying vec3 p; uniform vec4 plane, paint; void main() { if (dot(p, plane.xyz) > plane.w) discard; gl_FragColor = paint; }";
    const round = "precision highp float; varying vec3 p, c; uniform vec4 plane; void main() { if (dot(p, plane.xyz) > plane.w || length(gl_PointCoord - 0.5) > 0.5) discard; gl_FragColor = vec4(c, 1.0); }";
    const program = function (vertex, fragment) {
      const out = gl.createProgram();
      [[gl.VERTEX_SHADER, common + vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(function (s) {
        const shader = gl.createShader(s[0]);
        gl.shaderSource(shader, s[1]); gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(out, shader);
      });
      gl.linkProgram(out);
      if (!gl.getProgramParameter(out, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(out));
      const cache = {};
      return { it: out, u: function (name) { return name in cache ? cache[name] : (cache[name] = gl.getUniformLocation(out, name)); }, a: function (name) { return gl.getAttribLocation(out, name); } };
    };
    const surface = program("attribute vec3 place, normal; attribute vec3 color; varying vec3 e, n, p; varying vec3 c;\nvoid main() { p = place; e = eyes(place); n = eyes(normal); c = color; gl_Position = screen(e); }", light);
    // A tube: the axis plus an offset whose size is given in pixels, drawn a little towards the viewer.
    const tube = program("attribute vec3 place, offset; uniform float radius; varying vec3 p;\nvoid main() { p = place; vec3 a = eyes(place); float r = radius * (" + DISTANCE + ".0 - a.z); gl_Position = screen(a + r * eyes(offset) + vec3(0.0, 0.0, 0.5 * r)); }", plain);
    const wire = program("attribute vec3 place; varying vec3 p; uniform float lift;\nvoid main() { p = place; vec3 e = eyes(place); gl_Position = screen(e * (1.0 - lift / (" + DISTANCE + ".0 - e.z)) + vec3(0.0, 0.0, lift)); }", plain);
    const dots = program("attribute vec3 place, color; varying vec3 p, c; uniform float size;\nvoid main() { p = place; c = color; gl_Position = screen(eyes(place)); gl_PointSize = size; }", round);
    const buffer = function (data, kind) { const b = gl.createBuffer(); gl.bindBuffer(kind || gl.ARRAY_BUFFER, b); gl.bufferData(kind || gl.ARRAY_BUFFER, data, gl.STATIC_DRAW); return b; };
    const bind = function (prog, name, buf, size, stride, offset) {
      const a = prog.a(name); if (a < 0) return;
      gl.bindBuffer(gl.ARRAY_BUFFER, buf); gl.enableVertexAttribArray(a); gl.vertexAttribPointer(a, size, gl.FLOAT, false, stride || 0, offset || 0);
    };
    const colorBuffer = gl.createBuffer(), dotBuffer = gl.createBuffer(), order = gl.createBuffer();
    const fill = function (target, n, color) {
      const colors = new Float32Array(3 * n);
      for (let i = 0; i < n; i++) { const c = color(i); for (let k = 0; k < 3; k++) colors[3 * i + k] = c[k] / 255; }
      gl.bindBuffer(gl.ARRAY_BUFFER, target); gl.bufferData(gl.ARRAY_BUFFER, colors, gl.DYNAMIC_DRAW);
    };
    let colorKey = "";
    const dye = function (layout) {
      const own = layout.dots === layout.at, key = state.color + (dark() ? " dark " : " light ") + state.layout + state.points;
      if (key === colorKey) return;
      colorKey = key;
      fill(colorBuffer, 3 * count, function (i) { return vertexColor(Math.floor(i / 3), triangles[i]); });
      if (state.points) fill(dotBuffer, layout.dots.length / 3, function (i) { return dotColor(i, own); });
    };
    let orderKey = "";

    const SIDES = 10;
    const tubes = function (at, edges) {
      // Rings along each edge (axial part of the offset, radius), with rounded ends.
      const rings = [[0, -1, 0], [0, -0.75, 0.66], [0, 0, 1], [1, 0, 1], [1, 0.75, 0.66], [1, 1, 0]];
      const n = edges.length / 2, vertices = new Float32Array(n * rings.length * SIDES * 6), index = new Uint32Array(n * (rings.length - 1) * SIDES * 6);
      let v = 0, x = 0;
      for (let s = 0; s < n; s++) {
        const a = 3 * edges[2 * s], b = 3 * edges[2 * s + 1];
        const d = unit([at[b] - at[a], at[b + 1] - at[a + 1], at[b + 2] - at[a + 2]]);
        const u = unit(cross(d, Math.abs(d[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0])), w = cross(d, u), first = v / 6;
        rings.forEach(function (ring, r) {
          const o = ring[0] ? b : a;
          for (let k = 0; k < SIDES; k++) {
            const c = Math.cos(2 * Math.PI * k / SIDES) * ring[2], f = Math.sin(2 * Math.PI * k / SIDES) * ring[2];
            for (let i = 0; i < 3; i++) { vertices[v + i] = at[o + i]; vertices[v + 3 + i] = u[i] * c + w[i] * f + d[i] * ring[1]; }
            v += 6;
            if (r) {
              const p = first + r * SIDES + k, q = first + r * SIDES + (k + 1) % SIDES;
              index.set([p, q, p - SIDES, q, q - SIDES, p - SIDES], x); x += 6;
            }
          }
        });
      }
      return { vertices: buffer(vertices), index: buffer(index, gl.ELEMENT_ARRAY_BUFFER), count: index.length };
    };
    const upload = function (layout) {
      if (layout.gl) return layout.gl;
      const at = layout.at, spread = function (source, per) {
        const out = new Float32Array(9 * count);
        for (let t = 0; t < 3 * count; t++) for (let c = 0; c < 3; c++) out[3 * t + c] = per(source, t, c);
        return buffer(out);
      };
      const wires = scene.pieces.map(function () { return []; });
      for (let i = 0; i < meshEdges.length; i += 3) wires[meshEdges[i + 2]].push(meshEdges[i], meshEdges[i + 1]);
      return (layout.gl = {
        places: spread(at, function (s, t, c) { return s[3 * triangles[t] + c]; }),
        smooth: buffer(layout.corner),
        flat: spread(layout.flat, function (s, t, c) { return s[3 * Math.floor(t / 3) + c]; }),
        vertices: buffer(at), dots: buffer(layout.dots), dotCount: layout.dots.length / 3,
        wires: wires.map(function (w) { return { index: buffer(new Uint32Array(w), gl.ELEMENT_ARRAY_BUFFER), count: w.length }; }),
        tubes: curves.map(function (c) { return tubes(at, c.edges); })
      });
    };
    // Visible triangles; back to front when they are transparent.
    const arrange = function (layout, m) {
      const sorted = state.opacity < 1;
      const key = state.pieces.join() + state.layout + (sorted ? m.slice(6).map(function (x) { return x.toFixed(3); }).join() : "");
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
      if (key === orderKey) return;
      orderKey = key;
      const list = [];
      for (let t = 0; t < count; t++) if (state.pieces[pieceOf[t]]) list.push(t);
      if (sorted) {
        const at = layout.at, depth = new Float32Array(count);
        list.forEach(function (t) {
          for (let k = 0; k < 3; k++) { const i = 3 * triangles[3 * t + k]; depth[t] += m[6] * at[i] + m[7] * at[i + 1] + m[8] * at[i + 2]; }
        });
        list.sort(function (a, b) { return depth[a] - depth[b]; });
      }
      const index = new Uint32Array(3 * list.length);
      list.forEach(function (t, i) { index[3 * i] = 3 * t; index[3 * i + 1] = 3 * t + 1; index[3 * i + 2] = 3 * t + 2; });
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.DYNAMIC_DRAW);
      arrange.count = index.length;
    };
    return function () {
      const layout = layouts[state.layout], g = upload(layout), cam = camera(), m = cam.m, plane = cut(m), b = ground();
      const use = function (prog) {
        gl.useProgram(prog.it);
        for (let i = 0; i < 8; i++) gl.disableVertexAttribArray(i);
        gl.uniform3f(prog.u("R"), m[0], m[1], m[2]); gl.uniform3f(prog.u("U"), m[3], m[4], m[5]); gl.uniform3f(prog.u("T"), m[6], m[7], m[8]);
        gl.uniform4f(prog.u("lens"), 2 * cam.focal / cam.w, 2 * cam.focal / cam.h, 2 * cam.middle[0] / cam.w - 1, 1 - 2 * cam.middle[1] / cam.h);
        gl.uniform4fv(prog.u("plane"), plane);
      };
      dye(layout);
      gl.viewport(0, 0, cam.w, cam.h);
      gl.clearColor(b[0] / 255, b[1] / 255, b[2] / 255, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST); gl.depthFunc(gl.LEQUAL);
      gl.enable(gl.BLEND); gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      curves.forEach(function (c, i) {
        if (!state.curves[i]) return;
        use(tube);
        const k = ink(c.color), t = g.tubes[i];
        gl.uniform4f(tube.u("paint"), k[0] / 255, k[1] / 255, k[2] / 255, 1);
        gl.uniform1f(tube.u("radius"), curveWidth(c, cam) / 2 / cam.focal);
        bind(tube, "place", t.vertices, 3, 24, 0); bind(tube, "offset", t.vertices, 3, 24, 12);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, t.index);
        gl.drawElements(gl.TRIANGLES, t.count, gl.UNSIGNED_INT, 0);
      });
      if (state.points) {
        use(dots);
        gl.uniform1f(dots.u("size"), 3.2 * cam.ratio);
        bind(dots, "place", g.dots, 3); bind(dots, "color", dotBuffer, 3);
        gl.drawArrays(gl.POINTS, 0, g.dotCount);
      }
      const wireframe = function () {
        if (!state.edges) return;
        use(wire);
        gl.depthMask(false);
        if (state.opacity > 0 || !dark()) gl.uniform4f(wire.u("paint"), 0.05, 0.05, 0.08, 0.42); else gl.uniform4f(wire.u("paint"), 0.9, 0.9, 0.95, 0.42);
        gl.uniform1f(wire.u("lift"), 1.6 * DISTANCE / cam.focal);
        bind(wire, "place", g.vertices, 3);
        g.wires.forEach(function (w, i) {
          if (!state.pieces[i]) return;
          gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, w.index);
          gl.drawElements(gl.LINES, w.count, gl.UNSIGNED_INT, 0);
        });
        gl.depthMask(true);
      };
      if (state.opacity > 0 && count) {
        use(surface);
        bind(surface, "place", g.places, 3); bind(surface, "normal", state.smooth ? g.smooth : g.flat, 3); bind(surface, "color", colorBuffer, 3);
        gl.uniform1f(surface.u("alpha"), state.opacity);
        gl.uniform1f(surface.u("rimWidth"), state.keep < 1 ? 2 * cam.ratio * DISTANCE / cam.focal : 0);
        arrange(layout, m);
        gl.depthMask(state.opacity >= 1);
        gl.drawElements(gl.TRIANGLES, arrange.count, gl.UNSIGNED_INT, 0);
        gl.depthMask(true);
      }
      wireframe();
      const marks = shownMarks(layout);
      if (marks.length) {
        use(dots);
        gl.disable(gl.DEPTH_TEST);
        gl.uniform1f(dots.u("size"), MARK_SIZE * cam.ratio);
        const at = buffer(new Float32Array(marks)), dye = gl.createBuffer();
        fill(dye, marks.length / 3, function () { return MARK; });
        bind(dots, "place", at, 3); bind(dots, "color", dye, 3);
        gl.drawArrays(gl.POINTS, 0, marks.length / 3);
        gl.deleteBuffer(at); gl.deleteBuffer(dye);
      }
    };
  };

  // ---- painter 2: canvas in the plane, furthest first -------------------------------------------
  const flatCanvas = function () {
    const pen = canvas.getContext("2d");
    if (!pen) return null;
    return function () {
      const layout = layouts[state.layout], at = layout.at, cam = camera(), m = cam.m, plane = cut(m), b = ground();
      const S = project(at, cam, plane), things = [];
      if (state.opacity > 0) for (let t = 0; t < count; t++) {
        const i = 4 * triangles[3 * t], j = 4 * triangles[3 * t + 1], k = 4 * triangles[3 * t + 2];
        if (state.pieces[pieceOf[t]] && S[i + 3] && S[j + 3] && S[k + 3]) things.push([(S[i + 2] + S[j + 2] + S[k + 2]) / 3, t, -1, 0]);
      }
      curves.forEach(function (c, n) {
        if (!state.curves[n]) return;
        const lift = 1.5 * curveWidth(c, cam) * DISTANCE / cam.focal;
        for (let e = 0; e < c.edges.length; e += 2) {
          const i = 4 * c.edges[e], j = 4 * c.edges[e + 1];
          if (S[i + 3] && S[j + 3]) things.push([(S[i + 2] + S[j + 2]) / 2 - lift, e, n, 1]);
        }
      });
      const D = state.points ? (layout.dots === at ? S : project(layout.dots, cam, plane)) : [];
      for (let i = 0; i < D.length; i += 4) if (D[i + 3]) things.push([D[i + 2], i, 0, 2]);
      things.sort(function (p, q) { return q[0] - p[0]; });
      pen.fillStyle = "rgb(" + b + ")";
      pen.fillRect(0, 0, cam.w, cam.h);
      pen.lineJoin = pen.lineCap = "round";
      things.forEach(function (o) {
        if (o[3] === 2) { pen.fillStyle = "rgb(" + dotColor(o[1] / 4, layout.dots === at) + ")"; pen.fillRect(D[o[1]] - 1.5, D[o[1] + 1] - 1.5, 3, 3); return; }
        if (o[3] === 1) {
          const c = curves[o[2]], i = 4 * c.edges[o[1]], j = 4 * c.edges[o[1] + 1];
          pen.strokeStyle = "rgb(" + ink(c.color) + ")"; pen.lineWidth = curveWidth(c, cam);
          pen.beginPath(); pen.moveTo(S[i], S[i + 1]); pen.lineTo(S[j], S[j + 1]); pen.stroke();
          return;
        }
        const t = o[1], n = [layout.flat[3 * t], layout.flat[3 * t + 1], layout.flat[3 * t + 2]];
        let e = [m[0] * n[0] + m[1] * n[1] + m[2] * n[2], m[3] * n[0] + m[4] * n[1] + m[5] * n[2], m[6] * n[0] + m[7] * n[1] + m[8] * n[2]];
        if (e[2] < 0) e = [-e[0], -e[1], -e[2]];
        const shine = (0.40 + 0.60 * Math.max(0, -0.4137 * e[0] + 0.5976 * e[1] + 0.687 * e[2]) + 0.14 * Math.max(0, 0.8137 * e[0] - 0.1162 * e[1] + 0.5695 * e[2])) * (1 - 0.5 * Math.pow(1 - Math.min(1, e[2]), 3));
        const c = vertexColor(t, triangles[3 * t]).map(function (x) { return Math.min(255, Math.round(x * shine)); });
        pen.globalAlpha = state.opacity;
        pen.fillStyle = "rgb(" + c + ")";
        pen.strokeStyle = state.edges ? "rgba(15,15,20,.5)" : pen.fillStyle;
        pen.lineWidth = state.opacity < 1 && !state.edges ? 0.01 : 0.8;
        pen.beginPath();
        for (let k = 0; k < 3; k++) { const i = 4 * triangles[3 * t + k]; if (k) pen.lineTo(S[i], S[i + 1]); else pen.moveTo(S[i], S[i + 1]); }
        pen.closePath(); pen.fill(); pen.stroke();
        pen.globalAlpha = 1;
      });
      const M = project(shownMarks(layout), cam, plane);
      pen.fillStyle = "rgb(" + MARK + ")";
      for (let i = 0; i < M.length; i += 4) {
        if (!M[i + 3]) continue;
        pen.beginPath(); pen.arc(M[i], M[i + 1], MARK_SIZE / 2 * cam.ratio, 0, 7); pen.fill();
      }
    };
  };

  // ---- drawing when something changed -------------------------------------------------------------
  let painter = null, waiting = false, last = 0;
  const paint = function () {
    const ratio = Math.min(2, window.devicePixelRatio || 1), w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    prepare(layouts[state.layout], state.layout);
    if (painter) painter();
  };
  const redraw = function () {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(function (now) {
      waiting = false;
      if (state.spin) {
        turn = times(about([0, 1, 0], Math.min(0.05, (now - last) / 1000) * 0.6), turn);
        last = now;
      }
      paint();
      if (state.spin) redraw();
    });
  };
  const trouble = document.getElementById("trouble");
  const begin = function (plain) {
    try { painter = plain ? null : webgl(); } catch (error) { painter = null; trouble.textContent = "WebGL failed: " + error.message; }
    if (!painter) {
      painter = flatCanvas();
      trouble.textContent += painter ? "Drawn without WebGL: slower, flat shading, depth by triangle." : " Nothing can be drawn.";
    }
  };

  // ---- picking: the nearest to the viewer of what is drawn close to a place of the page ---------
  const CLOSE = 10;
  const told = function (x) { return Math.abs(x) >= 1e5 || (x !== 0 && Math.abs(x) < 1e-3) ? x.toExponential(3) : String(Number(x.toPrecision(5))); };
  const used = new Uint8Array(layouts[0].places.length / 3);
  const describe = function (kind, i) {
    if (kind === "mark") return [scene.layouts[state.layout].mark_texts[i]];
    const own = kind === "vertex", row = own ? (vertexRows.length ? vertexRows[i] : -1) : pointRows.length ? pointRows[i] : i;
    const lines = [own ? "vertex " + i + (row < 0 ? ", no row of the points" : ", row " + row + " of the points") : "row " + row + " of the points"];
    scalars.forEach(function (s) {
      const list = own ? s.vertices : s.points;
      if (list.length && isFinite(list[i])) lines.push(s.name + ": " + told(list[i]));
    });
    return lines;
  };
  const pick = function (x, y) {
    const layout = layouts[state.layout], cam = camera(), plane = cut(cam.m);
    let best = null;
    const look = function (kind, list, wanted) {
      const S = project(list, cam, plane);
      for (let i = 0; i < S.length / 4; i++) {
        if (!S[4 * i + 3] || !wanted(i) || Math.hypot(S[4 * i] / cam.ratio - x, S[4 * i + 1] / cam.ratio - y) > CLOSE) continue;
        if (!best || S[4 * i + 2] < best.away) best = { kind: kind, i: i, away: S[4 * i + 2], at: [list[3 * i], list[3 * i + 1], list[3 * i + 2]], layout: state.layout };
      }
    };
    if (state.marks) look("mark", layout.marks, function () { return true; });
    if (!best) {
      for (let t = 0; t < count; t++) if (state.pieces[pieceOf[t]]) for (let k = 0; k < 3; k++) used[triangles[3 * t + k]] = 1;
      look("vertex", layout.at, function (i) { return used[i] || count === 0; });
      if (state.points && layout.dots !== layout.at) look("point", layout.dots, function () { return true; });
      used.fill(0);
    }
    state.picked = best;
    document.getElementById("picked").textContent = best ? describe(best.kind, best.i).join("\n") : "";
    redraw();
  };

  // ---- hands ------------------------------------------------------------------------------------------
  const fingers = new Map();
  // Where a press began that may become a click.
  let pressed = null;
  const rotate = function (dx, dy) {
    const speed = 0.0075 / Math.max(1, Math.sqrt(state.zoom));
    turn = times(times(about([0, 1, 0], dx * speed), about([1, 0, 0], dy * speed)), turn);
  };
  const zoomBy = function (factor, x, y) {
    const old = state.zoom, cam = camera();
    state.zoom = Math.min(60, Math.max(0.15, old * factor));
    if (x !== undefined) {
      const f = state.zoom / old, base = [cam.middle[0] / cam.ratio, cam.middle[1] / cam.ratio];
      state.pan[0] += (x - base[0]) * (1 - f); state.pan[1] += (y - base[1]) * (1 - f);
    }
  };
  canvas.addEventListener("pointerdown", function (e) {
    canvas.setPointerCapture(e.pointerId); canvas.classList.add("held");
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    pressed = fingers.size === 1 && e.button === 0 ? [e.clientX, e.clientY] : null;
  });
  canvas.addEventListener("pointermove", function (e) {
    const before = fingers.get(e.pointerId);
    if (!before) return;
    const dx = e.clientX - before[0], dy = e.clientY - before[1];
    if (fingers.size >= 2) {
      const two = Array.from(fingers.keys()).slice(0, 2);
      if (two.indexOf(e.pointerId) < 0) return;
      const other = fingers.get(two[0] === e.pointerId ? two[1] : two[0]);
      const was = Math.hypot(before[0] - other[0], before[1] - other[1]), is = Math.hypot(e.clientX - other[0], e.clientY - other[1]);
      state.pan[0] += dx / 2; state.pan[1] += dy / 2;
      if (was > 5 && is > 5) zoomBy(is / was, (e.clientX + other[0]) / 2, (e.clientY + other[1]) / 2);
    } else if (e.shiftKey || e.ctrlKey || (e.buttons & 6)) { state.pan[0] += dx; state.pan[1] += dy; } else rotate(dx, dy);
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    redraw();
  });
  canvas.addEventListener("pointerup", function (e) {
    if (pressed && Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) < 4) pick(e.clientX, e.clientY);
    pressed = null;
  });
  const release = function (e) { fingers.delete(e.pointerId); if (!fingers.size) canvas.classList.remove("held"); };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("contextmenu", function (e) { e.preventDefault(); });
  canvas.addEventListener("wheel", function (e) {
    e.preventDefault();
    zoomBy(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0014)), e.clientX, e.clientY); redraw();
  }, { passive: false });
  canvas.addEventListener("dblclick", function () { home(); redraw(); });
  canvas.addEventListener("keydown", function (e) {
    const step = { ArrowLeft: [-24, 0], ArrowRight: [24, 0], ArrowUp: [0, -24], ArrowDown: [0, 24] }[e.key];
    if (step && e.shiftKey) { state.pan[0] += step[0]; state.pan[1] += step[1]; } else if (step) rotate(step[0], step[1]);
    else if (e.key === "+" || e.key === "=") zoomBy(1.15); else if (e.key === "-") zoomBy(1 / 1.15); else if (e.key === "Home" || e.key === "0") home(); else return;
    e.preventDefault(); redraw();
  });
  window.addEventListener("resize", redraw);

  // ---- panel ---------------------------------------------------------------------------------------------
  const box = function (parent, name, on, change, color, note, line) {
    const label = document.createElement("label"), input = document.createElement("input"), text = document.createElement("span");
    input.type = "checkbox"; input.checked = on; text.textContent = name; text.className = "name";
    input.addEventListener("change", function () { change(input.checked); redraw(); });
    label.appendChild(input);
    if (color) { const s = document.createElement("span"); s.className = line ? "swatch line" : "swatch"; s.style.background = "rgb(" + color + ")"; label.appendChild(s); }
    label.appendChild(text);
    if (note !== undefined) { const c = document.createElement("span"); c.className = "count"; c.textContent = note; label.appendChild(c); }
    document.getElementById(parent).appendChild(label);
    return input;
  };
  const slide = function (id, change) {
    const input = document.getElementById(id);
    input.addEventListener("input", function () { change(Number(input.value)); redraw(); });
  };
  const sizes = scene.pieces.map(function () { return 0; });
  pieceOf.forEach(function (p) { sizes[p]++; });
  scene.pieces.forEach(function (p, i) { box("pieces", p.name, true, function (on) { state.pieces[i] = on; }, p.color, sizes[i] + " triangles"); });
  curves.forEach(function (c, i) { box("curves", c.name, true, function (on) { state.curves[i] = on; }, c.color, c.edges.length / 2 + " edges", true); });
  box("shows", "smooth shading", true, function (on) { state.smooth = on; });
  box("shows", "edges of triangles", false, function (on) { state.edges = on; });
  box("shows", layouts.some(function (l) { return l.points.length; }) ? "sample points" : "vertices", state.points, function (on) { state.points = on; });
  if (scene.layouts.some(function (l) { return l.mark_texts.length; })) box("shows", "marks", true, function (on) { state.marks = on; }, MARK);
  box("shows", "turn slowly", false, function (on) { state.spin = on; last = performance.now(); });
  const dyes = document.getElementById("color");
  ["piece"].concat(scalars.map(function (s) { return s.name; })).forEach(function (name, i) {
    const o = document.createElement("option"); o.value = i - 1; o.textContent = name; dyes.appendChild(o);
  });
  const dyeBy = function (index) {
    state.color = index; dyes.value = index;
    const s = scalars[index], scale = document.getElementById("scale");
    scale.hidden = !s;
    if (s) {
      document.getElementById("low").textContent = told(s.low); document.getElementById("high").textContent = told(s.high);
      document.getElementById("ramp").style.background = "linear-gradient(90deg, " + STOPS.map(function (c) { return "rgb(" + c + ")"; }).join(", ") + ")";
    }
    redraw();
  };
  dyes.addEventListener("change", function () { dyeBy(Number(dyes.value)); });
  if (!scalars.length) dyes.parentElement.hidden = true;
  const choice = document.getElementById("layout");
  layouts.forEach(function (l, i) { const o = document.createElement("option"); o.value = i; o.textContent = l.name; choice.appendChild(o); });
  choice.addEventListener("change", function () { state.layout = Number(choice.value); prepare(layouts[state.layout], state.layout); home(); redraw(); });
  slide("opacity", function (v) { state.opacity = v; });
  slide("keep", function (v) { state.keep = v; });
  slide("width", function (v) { state.width = v; });
  document.getElementById("axis").addEventListener("change", function (e) { state.axis = e.target.value; redraw(); });
  document.getElementById("home").addEventListener("click", function () { home(); redraw(); });
  const theme = function (name) { document.documentElement.dataset.theme = name; redraw(); };
  document.getElementById("theme").addEventListener("click", function () { theme(dark() ? "light" : "dark"); });
  document.getElementById("fold").addEventListener("click", function () { document.body.classList.toggle("folded"); redraw(); });
  document.getElementById("save").addEventListener("click", function () {
    paint();
    const link = document.createElement("a");
    link.download = "picture.png"; link.href = canvas.toDataURL("image/png"); link.click();
  });
  canvas.addEventListener("webglcontextlost", function (e) { e.preventDefault(); painter = null; });
  canvas.addEventListener("webglcontextrestored", function () { layouts.forEach(function (l) { l.gl = null; }); begin(false); redraw(); });

  if (window.matchMedia && window.matchMedia("(prefers-color-scheme: dark)").matches) document.documentElement.dataset.theme = "dark";
  if (window.innerWidth <= 640) document.body.classList.add("folded");
  // #plain asks for the painter without WebGL; further words set what is shown, for links and tests.
  const words = location.hash.slice(1).split(",");
  begin(words.indexOf("plain") >= 0);
  words.forEach(function (w) {
    const part = w.split("="), value = Number(part[1]);
    if (["opacity", "keep", "zoom", "width", "layout"].indexOf(part[0]) >= 0 && isFinite(value)) {
      state[part[0]] = part[0] === "layout" ? Math.max(0, Math.min(layouts.length - 1, Math.floor(value))) : part[0] === "zoom" ? Math.min(60, Math.max(0.15, value)) : Math.max(0, value);
      const input = document.getElementById(part[0]); if (input) input.value = value;
    }
    if (w === "edges") { state.edges = true; document.querySelectorAll("#shows input")[1].checked = true; }
    if (part[0] === "color") dyeBy(scalars.findIndex(function (s) { return s.name === decodeURIComponent(part[1]); }));
    if (w === "points") { state.points = true; document.querySelectorAll("#shows input")[2].checked = true; }
    if (w === "dark" || w === "light") theme(w);
  });
  prepare(layouts[state.layout], state.layout);
  const zoomed = state.zoom; home(); state.zoom = zoomed;
  words.forEach(function (w) {
    // As shares of width and height.
    const part = /^pick=([\d.]+):([\d.]+)$/.exec(w);
    if (part) { paint(); pick(Number(part[1]) * canvas.clientWidth, Number(part[2]) * canvas.clientHeight); }
  });
  redraw();
})();
