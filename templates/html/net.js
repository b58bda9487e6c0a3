"use strict";
(function () {
  var root = document.documentElement;
  root.classList.add("script");
  var box = document.getElementById("search");
  var names = document.getElementById("names");
  var items = Array.prototype.slice.call(names.getElementsByTagName("li"));
  function filter() {
    var words = box.value.toLowerCase().trim();
    names.classList.toggle("open", words !== "");
    items.forEach(function (item) {
      item.classList.toggle("no", item.textContent.toLowerCase().indexOf(words) < 0);
    });
  }
  box.addEventListener("input", filter);
  box.addEventListener("keydown", function (event) {
    if (event.key !== "Enter") { return; }
    var first = names.querySelector("li:not(.no) a");
    if (first && box.value.trim() !== "") { first.click(); }
  });
  document.addEventListener("keydown", function (event) {
    if (event.key === "/" && document.activeElement !== box) { event.preventDefault(); box.focus(); }
  });
  var zoom = 1;
  Array.prototype.forEach.call(document.querySelectorAll(".zoom button"), function (button) {
    button.addEventListener("click", function () {
      var step = button.getAttribute("data-zoom");
      zoom = step === "1" ? 1 : Math.min(8, Math.max(0.1, zoom * Number(step)));
      root.style.setProperty("--zoom", String(zoom));
    });
  });
  function show() {
    var target = location.hash && document.getElementById(location.hash.slice(1));
    if (target && target.closest("svg")) { target.scrollIntoView({ block: "center", inline: "center" }); }
  }
  window.addEventListener("hashchange", show);
  show();
  filter();
})();
