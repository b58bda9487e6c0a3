"use strict";
// The picture can be zoomed and moved, and nodes can be found. Without scripts the page is read by scrolling.
(function () {
  var MOST = 50;
  // Where the whole picture has more units for each pixel than that, its beginning is shown first.
  var SMALLEST = 4;
  var LEAST = 20;
  var sheet = document.querySelector(".sheet");
  var svg = sheet.querySelector("svg");
  var whole = svg.viewBox.baseVal;
  var all = { x: whole.x, y: whole.y, width: whole.width, height: whole.height };
  var tools = document.getElementById("tools");
  var box = document.getElementById("search");
  var results = document.getElementById("results");
  document.documentElement.classList.add("script");
  // A large picture is on a canvas: as a drawing of the browser it would take a second for each move.
  var picture = window.graphCanvas ? window.graphCanvas(svg, sheet, whole) : null;
  function size() {
    var shown = picture ? picture.canvas : svg;
    return { width: Math.max(shown.clientWidth, 1), height: Math.max(shown.clientHeight, 1) };
  }
  tools.hidden = false;
  sheet.tabIndex = 0;
  sheet.setAttribute("role", "group");
  sheet.setAttribute("aria-label", "State space: plus and minus zoom, arrow keys move, 0 shows all");

  // Units of the drawing for each pixel.
  function scale() {
    return Math.max(whole.width / size().width, whole.height / size().height);
  }
  function look(x, y, width) {
    var ratio = size().height / size().width;
    whole.width = Math.min(Math.max(width, LEAST), 4 * Math.max(all.width, all.height / ratio));
    whole.height = whole.width * ratio;
    whole.x = x - whole.width / 2;
    whole.y = y - whole.height / 2;
    if (picture) { picture.look(); }
  }
  function middle() {
    return { x: whole.x + whole.width / 2, y: whole.y + whole.height / 2 };
  }
  function fit() {
    var ratio = size().height / size().width;
    look(all.x + all.width / 2, all.y + all.height / 2, Math.max(all.width, all.height / ratio));
  }
  function zoom(factor, at) {
    var centre = middle();
    var point = at || centre;
    look(point.x + (centre.x - point.x) * factor, point.y + (centre.y - point.y) * factor, whole.width * factor);
  }
  function under(event) {
    if (picture) { return picture.under(event); }
    var place = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return { x: place.x, y: place.y };
  }

  sheet.addEventListener("wheel", function (event) {
    event.preventDefault();
    zoom(Math.pow(1.0015, event.deltaY), under(event));
  }, { passive: false });
  var from = null;
  var moved = false;
  sheet.addEventListener("pointerdown", function (event) {
    if (event.button !== 0) { return; }
    from = { x: event.clientX, y: event.clientY, centre: middle() };
    moved = false;
  });
  window.addEventListener("pointermove", function (event) {
    if (!from) { return; }
    var x = event.clientX - from.x;
    var y = event.clientY - from.y;
    if (!moved && Math.abs(x) + Math.abs(y) < 5) { return; }
    moved = true;
    look(from.centre.x - x * scale(), from.centre.y - y * scale(), whole.width);
  });
  window.addEventListener("pointerup", function () { from = null; });
  sheet.addEventListener("dragstart", function (event) { event.preventDefault(); });
  sheet.addEventListener("click", function (event) {
    if (moved) { event.preventDefault(); moved = false; }
  }, true);
  var steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  sheet.addEventListener("keydown", function (event) {
    var step = steps[event.key];
    var centre = middle();
    if (step) { look(centre.x + step[0] * whole.width / 8, centre.y + step[1] * whole.height / 8, whole.width); }
    else if (event.key === "+" || event.key === "=") { zoom(0.8); }
    else if (event.key === "-") { zoom(1.25); }
    else if (event.key === "0") { fit(); }
    else { return; }
    event.preventDefault();
  });
  tools.querySelectorAll("button").forEach(function (button) {
    button.addEventListener("click", function () {
      if (button.value === "0") { fit(); } else { zoom(Number(button.value)); }
    });
  });

  // The lines that end at a node: an arc's row says where, and what is drawn leads to the row.
  var lines = {};
  svg.querySelectorAll("a").forEach(function (a) {
    var row = a.getAttribute("href").slice(1);
    (lines[row] = lines[row] || []).push(a);  // the line, and its label
  });
  var ends = {};
  document.querySelectorAll("#arcs tbody tr").forEach(function (row) {
    var drawn = lines[row.id] || [];
    [row.cells[0].textContent.trim(), row.cells[1].textContent.trim()].forEach(function (number) {
      ends[number] = (ends[number] || []).concat(drawn);
    });
  });
  function boxOf(number) {
    var box = picture && picture.boxOf(number);
    if (box) { return { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top }; }
    return document.getElementById("node-" + number).getBBox();
  }
  function show() {
    var target = location.hash && document.getElementById(location.hash.slice(1));
    if (!target || !target.closest("svg")) { return; }
    var number = target.id.replace("node-", "");
    if (picture) { picture.mark(number, ends[number] || []); } else {
      svg.querySelectorAll("a.near").forEach(function (a) { a.classList.remove("near"); });
      (ends[number] || []).forEach(function (a) { a.classList.add("near"); });
      svg.classList.add("looked");
    }
    var place = boxOf(number);
    look(place.x + place.width / 2, place.y + place.height / 2, Math.min(whole.width, size().width));
    sheet.parentNode.scrollIntoView({ block: "nearest" });
    sheet.dataset.node = number;
    // The link that led here may be gone, and the browser has taken the focus from it.
    if (document.activeElement === document.body) { sheet.focus({ preventScroll: true }); }
  }
  window.addEventListener("hashchange", show);

  var rows = Array.prototype.map.call(document.querySelectorAll("#nodes tbody tr"), function (row) {
    return { number: row.cells[0].textContent.trim(), text: row.querySelector("pre").textContent.toLowerCase(), row: row };
  });
  function find() {
    var words = box.value.toLowerCase().trim();
    results.textContent = "";
    results.hidden = words === "";
    if (words === "") { return; }
    var found = rows.filter(function (r) { return r.number === words || r.text.indexOf(words) >= 0; });
    found.sort(function (a, b) { return (b.number === words) - (a.number === words); });
    var head = document.createElement("li");
    head.textContent = found.length + (found.length === 1 ? " node" : " nodes") + (found.length > MOST ? ", the first " + MOST : "");
    results.appendChild(head);
    found.slice(0, MOST).forEach(function (r) {
      var item = document.createElement("li");
      var link = document.createElement("a");
      link.href = "#node-" + r.number;
      link.textContent = "node " + r.number;
      item.appendChild(link);
      item.appendChild(document.createTextNode(" " + r.row.querySelector("pre").textContent.replace(/\n/g, ", ").slice(0, 160)));
      results.appendChild(item);
    });
  }
  results.addEventListener("click", function (event) {
    if (event.target.closest("a")) { results.hidden = true; }
  });
  box.addEventListener("focus", find);
  box.addEventListener("input", find);
  box.addEventListener("keydown", function (event) {
    var first = results.querySelector("a");
    if (event.key === "Enter" && first) { location.hash = ""; first.click(); }
    if (event.key === "Escape") { box.value = ""; find(); }
  });
  document.addEventListener("keydown", function (event) {
    if (event.key === "/" && document.activeElement !== box) { event.preventDefault(); box.focus(); }
  });
  fit();
  if (scale() > SMALLEST) {
    var start = boxOf("1");
    look(start.x + start.width / 2, start.y + start.height / 2, size().width);
  }
  show();
})();
