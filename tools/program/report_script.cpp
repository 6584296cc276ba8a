// SPDX-License-Identifier: BSD-3-Clause
// Style and script of report.html. All texts enter the page as text nodes, so none is interpreted as markup.
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
.controls > * { margin-right: 14px }
.dot { display: inline-block; width: 10px; height: 10px; margin-right: 4px }
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
  if (value === null) return 'not a number';
  if (typeof value !== 'number' || Number.isInteger(value)) return String(value);
  return String(Number(value.toPrecision(6)));
}
const simple = value => value === null || typeof value !== 'object';
const flat = value => simple(value) || (Array.isArray(value) && value.every(simple));
const isRows = value => {
  const all = Object.values(value);
  return all.length > 0 && all.every(row => !simple(row) && !Array.isArray(row));
};
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
  const at = place('convergence');
  make(at, 'h2', 'Convergence');
  const colours = ['#1f77b4', '#ff7f0e', '#2ca02c', '#d62728', '#9467bd', '#8c564b', '#17becf'];
  const names = ['equilibrium', 'penetration', 'tension', 'complementarity', 'friction_cone', 'force_balance',
                 'duality_gap'];
  const of = name => lines.map(line => Math.log10(Number(line[head.indexOf(name)])));
  const all = names.flatMap(of).filter(v => Number.isFinite(v) && v > -18);
  if (all.length === 0) return make(at, 'p', 'No outer step has left residuals to be drawn.');
  const canvas = make(at, 'canvas'), pen = canvas.getContext('2d');
  canvas.width = 1000;
  canvas.height = 300;
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
)js";

}  // namespace kacanov
