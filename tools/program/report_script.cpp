// SPDX-License-Identifier: BSD-3-Clause
// Style and script of report.html. Texts reach the page as text nodes only, so that nothing in them is
// markup.
#include "program/report_page.hpp"

namespace kacanov {

const char* const report_style = R"css(
body { font: 15px/1.45 sans-serif; color: #222; max-width: 1000px; margin: 1.5em auto; padding: 0 1em }
h1 { font-size: 1.5em } h2 { font-size: 1.15em; margin-top: 1.8em } h3 { font-size: 1em }
table { border-collapse: collapse; margin: 0.3em 0 1em; display: block; overflow-x: auto }
td, th { border-bottom: 1px solid #ddd; padding: 2px 12px 2px 0; text-align: left; vertical-align: top }
.good { color: #1b6e2d } .bad { color: #a11 } .warning { border-left: 4px solid #d90; padding-left: 10px }
canvas { width: 100%; border: 1px solid #ccc; background: #fff; touch-action: none }
img { max-width: 100% } pre { background: #f5f5f5; padding: 10px; overflow-x: auto }
.controls > * { margin-right: 14px } .dot { display: inline-block; width: 10px; height: 10px; margin-right: 4px }
.bar { height: 14px; background: linear-gradient(to right, #440154, #3b528b, #21918c, #5ec962, #fde725) }
.ends { display: flex; justify-content: space-between }
)css";

const char* const report_script = R"js('use strict';
const data = id => JSON.parse(document.getElementById(id).textContent);
const result = data('result'), scene = data('scene'), steps = data('history');

function make(parent, tag, text, name) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (name) element.className = name;
  parent.append(element);
  return element;
}
const place = id => document.getElementById(id);
function brief(value) {
  if (typeof value !== 'number' || Number.isInteger(value)) return value === null ? 'not a number' : String(value);
  return String(Number(value.toPrecision(6)));
}
const simple = value => value === null || typeof value !== 'object';
const flat = value => simple(value) || (Array.isArray(value) && value.every(simple));
const isRows = value => Object.values(value).length > 0 && Object.values(value).every(row => !simple(row) && !Array.isArray(row));
function cellText(value) {
  if (simple(value)) return brief(value);
  if (Array.isArray(value)) return value.map(cellText).join(', ');
  return Object.entries(value).map(([key, entry]) => key + ' ' + cellText(entry)).join('; ');
}
function put(row, value) {
  make(row, 'td', cellText(value)).title = JSON.stringify(value);
}
function table(parent, object) {
  const body = make(parent, 'table');
  for (const [key, value] of Object.entries(object)) {
    const row = make(body, 'tr');
    make(row, 'th', key);
    put(row, value);
  }
}
function rows(parent, list) {
  const body = make(parent, 'table'), head = make(body, 'tr');
  const keys = [...new Set(Object.values(list).flatMap(Object.keys))];
  make(head, 'th', '');
  keys.forEach(key => make(head, 'th', key));
  for (const [name, entry] of Object.entries(list)) {
    const row = make(body, 'tr');
    make(row, 'th', Array.isArray(list) ? String(Number(name) + 1) : name);
    keys.forEach(key => key in entry ? put(row, entry[key]) : make(row, 'td', ''));
  }
}

function verdict() {
  const at = place('verdict');
  make(at, 'p', result.status.replaceAll('_', ' '), result.status === 'converged' ? 'good' : 'bad');
  make(at, 'p', result.message);
  for (const text of result.warnings || []) make(at, 'p', 'Warning: ' + text, 'warning');
}

function numbers() {
  const at = place('numbers'), own = {};
  for (const [key, value] of Object.entries(result))
    if (flat(value) && !['status', 'message', 'warnings'].includes(key)) own[key] = value;
  make(at, 'h2', 'Numbers');
  table(at, own);
  for (const [key, value] of Object.entries(result)) {
    if (flat(value) || key === 'case') continue;
    make(at, 'h2', key.replaceAll('_', ' '));
    if (isRows(value)) rows(at, value); else table(at, value);
  }
  make(at, 'h2', 'The case as it was run');
  make(at, 'pre', JSON.stringify(result.case, null, 2));
  make(at, 'p', 'kacanov ' + result.version);
}

function convergence() {
  const [head, ...lines] = steps.trim().split('\n').map(line => line.split(','));
  if (lines.length === 0) return;
  const at = place('convergence');
  make(at, 'h2', 'Convergence');
  const canvas = make(at, 'canvas'), pen = canvas.getContext('2d');
  canvas.width = 1000;
  canvas.height = 300;
  const colours = ['#1f77b4', '#ff7f0e', '#2ca02c', '#d62728', '#9467bd', '#8c564b', '#17becf'];
  const names = ['equilibrium', 'penetration', 'tension', 'complementarity', 'friction_cone', 'force_balance', 'duality_gap'];
  const of = name => lines.map(line => Math.log10(Number(line[head.indexOf(name)])));
  const all = names.flatMap(of).filter(v => Number.isFinite(v) && v > -18);
  if (all.length === 0) return;
  const low = Math.floor(Math.min(...all)), high = Math.max(low + 1, Math.ceil(Math.max(...all)));
  const x = i => 60 + 740 * (lines.length > 1 ? i / (lines.length - 1) : 0.5);
  const y = v => 270 - 250 * (v - low) / (high - low);
  pen.font = '13px sans-serif';
  for (let v = low; v <= high; v += Math.ceil((high - low) / 8)) {
    pen.fillStyle = '#444';
    pen.fillText('1e' + v, 15, y(v) + 4);
    pen.fillStyle = '#ddd';
    pen.fillRect(60, y(v), 740, 1);
  }
  pen.fillStyle = '#444';
  pen.fillText('outer step 1 to ' + lines.length, 360, 293);
  names.forEach((name, k) => {
    pen.strokeStyle = pen.fillStyle = colours[k];
    pen.fillText(name, 815, 40 + 20 * k);
    pen.beginPath();
    let down = false;
    of(name).forEach((v, i) => {
      const seen = Number.isFinite(v) && v >= low;
      if (seen && down) pen.lineTo(x(i), y(v)); else if (seen) pen.moveTo(x(i), y(v));
      if (seen) pen.fillRect(x(i) - 2, y(v) - 2, 4, 4);
      down = seen;
    });
    pen.stroke();
  });
}
)js"
                                  R"js(
const vertexShader = `#version 300 es
in vec3 point, shift; in float value;
uniform mat3 turn; uniform float scale, size, zoom, aspect, nearer; uniform vec2 pan;
out vec3 seen; out float shade;
void main() {
  seen = turn * (point + scale * shift) / size;
  shade = value;
  gl_Position = vec4((seen.xy * zoom + pan) / vec2(aspect, 1.0), -seen.z / 8.0 - nearer, 1.0);
  gl_PointSize = 6.0;
}`;
const fragmentShader = `#version 300 es
precision highp float;
in vec3 seen; in float shade;
uniform float low, high; uniform vec4 plain; uniform vec3 stops[5];
out vec4 colour;
void main() {
  if (plain.a > 0.0) { colour = plain; return; }
  float t = 4.0 * clamp((shade - low) / (high - low), 0.0, 1.0);
  int k = min(int(t), 3);
  vec3 n = normalize(cross(dFdx(seen), dFdy(seen)));
  colour = vec4(mix(stops[k], stops[k + 1], t - float(k)) * (0.5 + 0.5 * abs(n.z)), 1.0);
}`;
const markColours = {support: [0.1, 0.3, 0.9, 1], load: [0.85, 0.1, 0.1, 1], spring: [0.6, 0.2, 0.7, 1], contact: [0.1, 0.1, 0.1, 1]};

function unpacked(text, Type) {
  return new Type(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
}
function program(gl) {
  const made = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertexShader], [gl.FRAGMENT_SHADER, fragmentShader]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  ['point', 'shift', 'value'].forEach((name, k) => gl.bindAttribLocation(made, k, name));
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  return made;
}
/** A square in the plane, two triangles, as wide as the body. */
function patch(plane, size) {
  const unit = v => { const l = Math.hypot(...v); return v.map(c => c / l); };
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const n = unit(plane.normal), s = unit(cross(n, Math.abs(n[2]) < 0.7 ? [0, 0, 1] : [1, 0, 0])), t = cross(n, s);
  const far = n.reduce((sum, c, k) => sum + c * plane.point[k], 0);
  const corner = (a, b) => n.map((c, k) => far * c + 0.6 * size * (a * s[k] + b * t[k]));
  return [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]].flatMap(([a, b]) => corner(a, b));
}
function start3d() {
  const at = place('view');
  make(at, 'h2', 'Body, to be turned');
  if (!scene.points)
    return make(at, 'p', `The surface has ${scene.triangles} triangles, more than the ${scene.most} that a page can hold well: open result.pvd in ParaView.`);
  const canvas = document.createElement('canvas'), gl = canvas.getContext('webgl2');
  if (!gl) return make(at, 'p', 'This browser has no WebGL 2, which this view needs.');
  canvas.width = 1000;
  canvas.height = 560;
  const u = unpacked(scene.displacement, Float32Array), length = new Float32Array(scene.nodes);
  for (let i = 0; i < scene.nodes; ++i) length[i] = Math.hypot(u[3 * i], u[3 * i + 1], u[3 * i + 2]);
  const most = length.reduce((a, b) => Math.max(a, b), 0);
  const fitting = scene.scale > 0 ? scene.scale : most > 0 && most < 0.015 * scene.size ? 0.06 * scene.size / most : 1;
  const fields = [{name: 'displacement', values: length}];
  scene.fields.forEach(f => fields.push({name: f.name, values: unpacked(f.values, Float32Array)}));
  const controls = make(at, 'p', undefined, 'controls'), select = make(controls, 'select');
  fields.forEach((f, k) => { make(select, 'option', f.name).value = k; });
  const slider = make(make(controls, 'label', 'displacement × '), 'input'), told = make(controls, 'span');
  Object.assign(slider, {type: 'range', min: 0, max: 3 * fitting, step: fitting / 100, value: fitting});
  at.append(canvas);
  make(at, 'div', undefined, 'bar');
  const ends = make(at, 'div', undefined, 'ends'), lowest = make(ends, 'span'), highest = make(ends, 'span');
  make(at, 'p', 'Drag: turn. Shift and drag: move. Wheel: nearer. Double click: as at the beginning.');
  const legend = make(at, 'p', undefined, 'controls'), marks = [];
  scene.marks.forEach(mark => {
    const entry = make(legend, 'label'), box = make(entry, 'input'), dot = make(entry, 'span', undefined, 'dot');
    const colour = markColours[mark.kind];
    Object.assign(box, {type: 'checkbox', checked: mark.nodes !== null && mark.kind !== 'contact', disabled: mark.nodes === null});
    dot.style.background = `rgb(${colour.slice(0, 3).map(c => 255 * c)})`;
    make(entry, 'span', `${mark.kind} ${mark.name}` + (mark.nodes === null ? ' (not on the surface)' : ''));
    box.onchange = draw;
    if (mark.nodes !== null) marks.push({colour, box, nodes: unpacked(mark.nodes, Uint32Array)});
  });
  if (scene.undrawn_obstacles > 0) make(at, 'p', 'Obstacles that are no planes, or that move, are not drawn.');

  const shader = program(gl), uniform = name => gl.getUniformLocation(shader, name);
  gl.useProgram(shader);
  gl.enable(gl.DEPTH_TEST);
  const buffer = (target, values) => {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, values, gl.STATIC_DRAW);
    return made;
  };
  const vertices = (list) => {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    list.forEach(([values, width], k) => {
      buffer(gl.ARRAY_BUFFER, values);
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, width, gl.FLOAT, false, 0, 0);
    });
    return array;
  };
  const points = unpacked(scene.points, Float32Array), corners = unpacked(scene.corners, Uint32Array);
  const bodies = fields.map(f => vertices([[points, 3], [u, 3], [f.values, 1]]));
  const triangles = buffer(gl.ELEMENT_ARRAY_BUFFER, corners);
  for (const mark of marks) mark.buffer = buffer(gl.ELEMENT_ARRAY_BUFFER, mark.nodes);
  const planes = scene.planes.map(plane => vertices([[new Float32Array(patch(plane, scene.size)), 3]]));
  gl.uniform3fv(uniform('stops'), [0x44, 0x01, 0x54, 0x3b, 0x52, 0x8b, 0x21, 0x91, 0x8c, 0x5e, 0xc9, 0x62, 0xfd, 0xe7, 0x25].map(c => c / 255));
  gl.uniform1f(uniform('size'), scene.size / 2);
  let turn, tilt, zoom, pan;
  const reset = () => {
    [turn, tilt] = scene.dim === 2 ? [0, 0] : [-0.6, -1.1];
    zoom = 0.9;
    pan = [0, 0];
  };
  const plain = (colour) => gl.uniform4fv(uniform('plain'), colour);
  function draw() {
    const field = Number(select.value), values = fields[field].values;
    const low = values.reduce((a, b) => Math.min(a, b), Infinity), high = values.reduce((a, b) => Math.max(a, b), -Infinity);
    told.textContent = brief(Number(slider.value));
    lowest.textContent = brief(low);
    highest.textContent = brief(high);
    const [c, s, d, e] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
    gl.uniformMatrix3fv(uniform('turn'), false, [c, d * s, e * s, -s, d * c, e * c, 0, -e, d]);
    for (const [name, value] of Object.entries({scale: slider.value, zoom, aspect: canvas.width / canvas.height, low, high: high > low ? high : low + 1, nearer: 0}))
      gl.uniform1f(uniform(name), value);
    gl.uniform2fv(uniform('pan'), pan);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    plain([0.87, 0.89, 0.91, 1]);
    for (const plane of planes) {
      gl.bindVertexArray(plane);
      gl.uniform1f(uniform('nearer'), -0.001);
      gl.drawArrays(gl.TRIANGLES, 0, 6);
    }
    gl.uniform1f(uniform('nearer'), 0);
    gl.bindVertexArray(bodies[field]);
    plain([0, 0, 0, 0]);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, triangles);
    gl.drawElements(gl.TRIANGLES, corners.length, gl.UNSIGNED_INT, 0);
    gl.uniform1f(uniform('nearer'), 0.002);
    for (const mark of marks.filter(m => m.box.checked)) {
      plain(mark.colour);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mark.buffer);
      gl.drawElements(gl.POINTS, mark.nodes.length, gl.UNSIGNED_INT, 0);
    }
  }
  canvas.onpointerdown = event => canvas.setPointerCapture(event.pointerId);
  canvas.onpointermove = event => {
    if (event.buttons === 0) return;
    if (event.shiftKey || event.buttons > 1) {
      pan = [pan[0] + 2 * event.movementX / canvas.clientHeight, pan[1] - 2 * event.movementY / canvas.clientHeight];
    } else {
      turn += 0.01 * event.movementX;
      tilt += 0.01 * event.movementY;
    }
    draw();
  };
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    zoom *= Math.exp(-0.001 * event.deltaY);
    draw();
  }, {passive: false});
  canvas.ondblclick = () => { reset(); draw(); };
  select.onchange = slider.oninput = draw;
  reset();
  draw();
  document.body.dataset.view = gl.getError() === 0 ? 'drawn' : 'failed';
}
verdict();
numbers();
convergence();
start3d();
)js";

}  // namespace kacanov
