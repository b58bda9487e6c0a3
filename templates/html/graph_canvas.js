"use strict";
// The picture of a large state space on a canvas: what is seen is drawn, and while it moves the last picture moves along.
window.graphCanvas = function (svg, sheet, view) {
  var LATER_MS = 90;
  var QUICK_MS = 24;
  var NEAR = "#ff8c00";
  var canvas = document.createElement("canvas");
  var kept = document.createElement("canvas");
  var keptView = null;
  var later = 0;
  var took = 0;
  var asked = false;
  var near = null;
  var target = 0;
  sheet.appendChild(canvas);
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "state space; the tables below have the same nodes and arcs");

  function number(node, name) { return Number(node.getAttribute(name)); }
  // The box of a path: of all its points, which are pairs of numbers but after V and H.
  function boxOf(d) {
    var found = { left: Infinity, top: Infinity, right: -Infinity, bottom: -Infinity };
    var x = 0;
    var y = 0;
    d.replace(/([MCLVHhz])([^MCLVHhz]*)/g, function (all, kind, rest) {
      var numbers = (rest.match(/-?[\d.]+/g) || []).map(Number);
      for (var i = 0; i < numbers.length; i += kind === "V" || kind === "H" ? 1 : 2) {
        if (kind === "V") { y = numbers[i]; } else if (kind === "H") { x = numbers[i]; } else if (kind === "h") { x += numbers[i]; } else {
          x = numbers[i];
          y = numbers[i + 1];
        }
        found.left = Math.min(found.left, x);
        found.right = Math.max(found.right, x);
        found.top = Math.min(found.top, y);
        found.bottom = Math.max(found.bottom, y);
      }
      return "";
    });
    return found;
  }
  var arcs = [];
  var nodes = {};
  svg.querySelectorAll("g.arc").forEach(function (g) {
    g.querySelectorAll("path").forEach(function (path) {
      if (path.getAttribute("stroke-opacity") === "0") { return; }
      var d = path.getAttribute("d");
      var fill = path.getAttribute("fill");
      arcs.push({
        link: g.parentNode, title: g.firstElementChild.textContent, box: boxOf(d), path: new Path2D(d),
        ink: fill === "none" ? path.getAttribute("stroke") : fill, isLine: fill === "none", width: number(path, "stroke-width"),
      });
    });
  });
  svg.querySelectorAll("g.node").forEach(function (g) {
    var made = { number: g.id.replace("node-", ""), title: g.firstElementChild.textContent, shapes: [], texts: [], box: null };
    g.querySelectorAll("rect").forEach(function (r) {
      var shape = {
        x: number(r, "x"), y: number(r, "y"), w: number(r, "width"), h: number(r, "height"), r: number(r, "rx"),
        fill: r.getAttribute("fill"), stroke: r.getAttribute("stroke"), width: number(r, "stroke-width"),
      };
      made.shapes.push(shape);
      made.box = made.box || { left: shape.x, top: shape.y, right: shape.x + shape.w, bottom: shape.y + shape.h };
    });
    g.querySelectorAll("text").forEach(function (t) {
      made.texts.push({ x: number(t, "x"), y: number(t, "y"), text: t.textContent, ink: t.getAttribute("fill") });
    });
    nodes[made.number] = made;
  });
  var list = Object.keys(nodes).map(function (n) { return nodes[n]; });

  function isSeen(box, part) {
    return box.right >= part.x && box.left <= part.x + part.width && box.bottom >= part.y && box.top <= part.y + part.height;
  }
  function whole(c, part, scale) {
    arcs.forEach(function (arc) {
      if (!isSeen(arc.box, part)) { return; }
      var isNear = near && near.has(arc.link);
      if (!arc.isLine && 8 * scale < 1.5) { return; }
      c.globalAlpha = near && !isNear ? 0.25 : 1;
      c.strokeStyle = c.fillStyle = isNear ? NEAR : arc.ink;
      c.lineWidth = Math.max(arc.width * (isNear ? 2 : 1), 0.35 / scale);
      if (arc.isLine) { c.stroke(arc.path); } else { c.fill(arc.path); }
    });
    c.globalAlpha = 1;
    c.textAlign = "center";
    c.font = "bold 13px Arial, 'Liberation Sans', Helvetica, sans-serif";
    list.forEach(function (node) {
      if (!isSeen(node.box, part)) { return; }
      node.shapes.forEach(function (s, i) {
        c.beginPath();
        if (c.roundRect) { c.roundRect(s.x, s.y, s.w, s.h, s.r); } else { c.rect(s.x, s.y, s.w, s.h); }
        if (s.fill !== "none") {
          c.fillStyle = s.fill;
          c.fill();
        }
        var isTarget = target === node.number && i === 0;
        c.strokeStyle = isTarget ? NEAR : s.stroke;
        c.lineWidth = isTarget ? 4 : s.width;
        c.stroke();
      });
      if (13 * scale < 3) { return; }
      node.texts.forEach(function (t) {
        c.fillStyle = t.ink;
        c.fillText(t.text, t.x, t.y);
      });
    });
  }
  function size() {
    var ratio = Math.min(window.devicePixelRatio || 1, 2);
    return { w: Math.max(Math.round(sheet.clientWidth * ratio), 1), h: Math.max(Math.round(canvas.clientHeight * ratio), 1) };
  }
  function copy(v) { return { x: v.x, y: v.y, width: v.width, height: v.height }; }
  // All of what is seen, drawn anew.
  function fresh() {
    clearTimeout(later);
    later = 0;
    var s = size();
    var began = performance.now();
    kept.width = s.w;
    kept.height = s.h;
    keptView = copy(view);
    var c = kept.getContext("2d");
    var scale = s.w / keptView.width;
    c.fillStyle = "#fff";
    c.fillRect(0, 0, s.w, s.h);
    c.setTransform(scale, 0, 0, scale, -keptView.x * scale, -keptView.y * scale);
    whole(c, keptView, scale);
    took = performance.now() - began;
    paint();
  }
  function paint() {
    var s = size();
    if (canvas.width !== s.w || canvas.height !== s.h) {
      canvas.width = s.w;
      canvas.height = s.h;
    }
    var c = canvas.getContext("2d");
    var scale = s.w / view.width;
    c.fillStyle = "#fff";
    c.fillRect(0, 0, s.w, s.h);
    c.drawImage(kept, (keptView.x - view.x) * scale, (keptView.y - view.y) * scale, keptView.width * scale, keptView.height * scale);
  }
  function under(event) {
    var box = canvas.getBoundingClientRect();
    var scale = view.width / box.width;
    return { x: view.x + (event.clientX - box.left) * scale, y: view.y + (event.clientY - box.top) * scale, scale: scale };
  }
  function at(event) {
    var p = under(event);
    var spot = { x: p.x, y: p.y, width: 0, height: 0 };
    var node = list.find(function (n) { return isSeen(n.box, spot); });
    if (node) { return { title: node.title, hash: "row-" + node.number }; }
    var c = kept.getContext("2d");
    var reach = { x: p.x - 4 * p.scale, y: p.y - 4 * p.scale, width: 8 * p.scale, height: 8 * p.scale };
    c.save();
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.lineWidth = 8 * p.scale;
    var arc = arcs.find(function (a) { return a.isLine && isSeen(a.box, reach) && c.isPointInStroke(a.path, p.x, p.y); });
    c.restore();
    return arc ? { title: arc.title, hash: arc.link.getAttribute("href").slice(1) } : null;
  }
  canvas.addEventListener("click", function (event) {
    var found = at(event);
    if (found) { location.hash = found.hash; }
  });
  canvas.addEventListener("pointermove", function (event) {
    if (event.buttons) { return; }
    clearTimeout(canvas.told);
    canvas.told = setTimeout(function () {
      var found = at(event);
      canvas.title = found ? found.title : "";
    }, LATER_MS);
  });
  new ResizeObserver(function () { if (keptView) { fresh(); } }).observe(sheet);
  return {
    canvas: canvas, under: under,
    boxOf: function (n) { return nodes[n] && nodes[n].box; },
    // A node and its lines, which are drawn with the look at them that follows.
    mark: function (number, lines) {
      target = number;
      near = new Set(lines);
      keptView = null;
    },
    look: function () {
      if (asked) { return; }
      asked = true;
      requestAnimationFrame(function () {
        asked = false;
        if (!keptView || took < QUICK_MS) {
          fresh();
          return;
        }
        paint();
        clearTimeout(later);
        later = setTimeout(fresh, LATER_MS);
      });
    },
  };
};
