"use strict";
// Under each drawing of a page: the drawing as a file, PNG for a slide, SVG for print. Pixels are
// made by the browser; figureAsPng(figure) gives them as a data URL.
const kPngWidth_px = 1800;

function figureAsSvg(figure, width_px) {
  const svg = figure.querySelector("svg").cloneNode(true);
  const box = figure.querySelector("svg").viewBox.baseVal;
  svg.setAttribute("width", width_px);
  svg.setAttribute("height", Math.round((width_px * box.height) / box.width));
  return new XMLSerializer().serializeToString(svg);
}

async function figureAsPng(figure) {
  const image = new Image();
  image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(figureAsSvg(figure, kPngWidth_px));
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext("2d");
  context.fillStyle = "#ffffff";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(image, 0, 0);
  return canvas.toDataURL("image/png");
}

(() => {
  const nameOf = (figure, index) => {
    const heading = figure.querySelector("h3")?.textContent ??
      figure.querySelector("svg").getAttribute("aria-label") ?? `figure ${index + 1}`;
    const moment = figure.closest(".maps")?.previousElementSibling?.textContent ?? "";
    return `${moment} ${heading}`.trim().replace(/[^A-Za-z0-9.]+/g, "-").toLowerCase();
  };
  function save(url, name) {
    const link = document.createElement("a");
    link.href = url;
    link.download = name;
    link.click();
  }
  [...document.querySelectorAll("figure")].forEach((figure, index) => {
    if (!figure.querySelector("svg")) return;
    const line = document.createElement("p");
    line.className = "save";
    const button = (text, act) => {
      const made = document.createElement("button");
      made.type = "button";
      made.textContent = text;
      made.addEventListener("click", act);
      line.append(made);
    };
    const name = nameOf(figure, index);
    button("PNG", async () => save(await figureAsPng(figure), name + ".png"));
    button("SVG", () => save(
      "data:image/svg+xml;charset=utf-8," + encodeURIComponent(figureAsSvg(figure, 900)), name + ".svg"));
    figure.append(line);
  });
})();
