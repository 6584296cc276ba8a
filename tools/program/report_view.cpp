// SPDX-License-Identifier: BSD-3-Clause
// The part of report.html's script that draws the body with WebGL 2, and the start of all parts.
#include "program/report_page.hpp"

namespace kacanov {

const char* const report_view = R"js(
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
const markColours = {support: [0.1, 0.3, 0.9, 1], load: [0.85, 0.1, 0.1, 1], spring: [0.6, 0.2, 0.7, 1],
                     contact: [0.1, 0.1, 0.1, 1]};

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
  const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
  const n = unit(plane.normal), s = unit(cross(n, Math.abs(n[2]) < 0.7 ? [0, 0, 1] : [1, 0, 0]));
  const t = cross(n, s);
  const far = n.reduce((sum, c, k) => sum + c * plane.point[k], 0);
  const corner = (a, b) => n.map((c, k) => far * c + 0.6 * size * (a * s[k] + b * t[k]));
  return [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]].flatMap(([a, b]) => corner(a, b));
}
/** The axis of revolution as a chain line: dashes and dots, two ends each. */
function chainLine({x, reach}, size) {
  const ends = [], dash = 0.06 * size, gap = 0.015 * size;
  for (let y = -reach; y < reach; y += dash + 3 * gap)
    ends.push(x, y, 0, x, y + dash, 0, x, y + dash + gap, 0, x, y + dash + 2 * gap, 0);
  return ends;
}
function start3d() {
  const at = place('view');
  make(at, 'h2', 'Body, to be turned');
  scene.not_shown.forEach(text => make(at, 'p', text));
  if (!scene.points)
    return make(at, 'p', `The surface has ${scene.triangles} triangles, more than the ${scene.most} that a ` +
                'page can hold well: open result.pvd in ParaView.');
  if (scene.fields.length === 0) return make(at, 'p', 'There are no fields to be shown.');
  const canvas = document.createElement('canvas'), gl = canvas.getContext('webgl2');
  if (!gl) return make(at, 'p', 'This browser has no WebGL 2, which this view needs.');
  canvas.width = 1000;
  canvas.height = 560;
  const u = unpacked(scene.displacement, Float32Array);
  let most = 0;
  for (let i = 0; i < u.length; i += 3) most = Math.max(most, Math.hypot(u[i], u[i + 1], u[i + 2]));
  const small = most > 0 && most < 0.015 * scene.size;
  const fitting = scene.scale > 0 ? scene.scale : small ? 0.06 * scene.size / most : 1;
  const fields = scene.fields.map(f => ({name: f.name, values: unpacked(f.values, Float32Array)}));
  const controls = make(at, 'p', undefined, 'controls'), select = make(controls, 'select');
  fields.forEach((f, k) => { make(select, 'option', f.name).value = k; });
  select.value = scene.first;
  const slider = make(make(controls, 'label', 'displacement × '), 'input'), told = make(controls, 'span');
  Object.assign(slider, {type: 'range', min: 0, max: 3 * fitting, step: fitting / 100, value: fitting});
  at.append(canvas);
  make(at, 'div', undefined, 'bar');
  const ends = make(at, 'div', undefined, 'ends'), lowest = make(ends, 'span'), highest = make(ends, 'span');
  make(at, 'p', 'Drag: turn. Shift and drag: move. Wheel: nearer. Double click: as at the beginning.');
  const legend = make(at, 'p', undefined, 'controls'), marks = [];
  scene.marks.forEach(mark => {
    const entry = make(legend, 'label'), box = make(entry, 'input');
    const dot = make(entry, 'span', undefined, 'dot');
    const colour = markColours[mark.kind];
    const there = mark.nodes !== null;
    Object.assign(box, {type: 'checkbox', checked: there && mark.kind !== 'contact', disabled: !there});
    dot.style.background = `rgb(${colour.slice(0, 3).map(c => 255 * c)})`;
    make(entry, 'span', `${mark.kind} ${mark.name}` + (there ? '' : ' (not on the surface)'));
    box.onchange = draw;
    if (there) marks.push({colour, box, nodes: unpacked(mark.nodes, Uint32Array)});
  });
  if (scene.axis) make(legend, 'span', 'chain line: axis of revolution');

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
  const others = unpacked(scene.obstacles, Float32Array), obstacles = vertices([[others, 3]]);
  const chain = new Float32Array(scene.axis ? chainLine(scene.axis, scene.size) : []);
  const axis = vertices([[chain, 3]]);
  const stops = [0x44, 0x01, 0x54, 0x3b, 0x52, 0x8b, 0x21, 0x91, 0x8c, 0x5e, 0xc9, 0x62, 0xfd, 0xe7, 0x25];
  gl.uniform3fv(uniform('stops'), stops.map(c => c / 255));
  gl.uniform1f(uniform('size'), scene.size / 2);
  let turn, tilt, zoom, pan;
  const reset = () => {
    [turn, tilt] = scene.dim === 2 ? [0, 0] : [-0.6, -1.1];
    if (scene.view) {
      const [x, y, z] = scene.view;
      [turn, tilt] = [Math.hypot(x, y) > 0 ? Math.atan2(-x, -y) : 0, -Math.acos(z / Math.hypot(x, y, z))];
    }
    zoom = scene.axis ? Math.min(0.9, 0.85 * scene.size / Math.abs(scene.axis.x)) : 0.9;
    pan = [0, 0];
  };
  const plain = (colour) => gl.uniform4fv(uniform('plain'), colour);
  function draw() {
    const field = Number(select.value), values = fields[field].values;
    const low = values.reduce((a, b) => Math.min(a, b), Infinity);
    const high = values.reduce((a, b) => Math.max(a, b), -Infinity);
    told.textContent = brief(Number(slider.value));
    lowest.textContent = brief(low);
    highest.textContent = brief(high);
    const [c, s, d, e] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
    gl.uniformMatrix3fv(uniform('turn'), false, [c, d * s, e * s, -s, d * c, e * c, 0, -e, d]);
    const aspect = canvas.width / canvas.height, above = high > low ? high : low + 1;
    const numbers = {scale: slider.value, zoom, aspect, low, high: above, nearer: 0};
    for (const [name, value] of Object.entries(numbers)) gl.uniform1f(uniform(name), value);
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
    if (others.length > 0) {
      gl.bindVertexArray(obstacles);
      plain(scene.dim === 2 ? [0.3, 0.3, 0.3, 1] : [0.8, 0.83, 0.86, 1]);
      gl.drawArrays(scene.dim === 2 ? gl.LINES : gl.TRIANGLES, 0, others.length / 3);
    }
    if (chain.length > 0) {
      gl.bindVertexArray(axis);
      plain([0.45, 0.45, 0.45, 1]);
      gl.drawArrays(gl.LINES, 0, chain.length / 3);
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
      const step = 2 / canvas.clientHeight;
      pan = [pan[0] + step * event.movementX, pan[1] - step * event.movementY];
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
