"use strict";
// Draws the plots of report.html from the JSON in the element "samples":
// { time_s: [...], plots: [{ axis, unit, span_gaps, series: [{ label, values, step, band }] }],
//   phases: [{ time_s, name }], marks: the same, of faults, or left out }. Values are in the unit of their plot; null means no value, which
// a line passes over where span_gaps is set. A step holds its value; a band is thin and dashed.
// A plot may have a time_s of its own.
(() => {
  const samples = JSON.parse(document.getElementById("samples").textContent);
  // Okabe and Ito's palette, told apart by colour-blind readers; without its yellow, too pale on
  // white, and with its black left to the text.
  const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
  const plotHeight_px = 250;
  const axisWidth_px = 70;

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const shown = (value) => (value === null || value === undefined ? "" : String(+value.toPrecision(4)));

  // A line where each begins, its name beside it; those that are close stand below one another.
  function drawTimes(plot, times, look) {
    const { ctx, bbox } = plot;
    const line_px = 13 * devicePixelRatio;
    let last = -Infinity, row = 0;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.strokeStyle = ctx.fillStyle = look.colour;
    ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.setLineDash(look.dash.map((length) => length * devicePixelRatio));
    ctx.textBaseline = "top";
    for (const time of times) {
      const x = plot.valToPos(time.time_s, "x", true);
      row = look.stacked && x - last < 12 * line_px ? row + 1 : 0;
      last = x;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      const y = bbox.top + 3 * devicePixelRatio + (look.rows_down + row) * line_px;
      const left = look.stacked && x > bbox.left + 0.75 * bbox.width;  // it would run out
      ctx.textAlign = left ? "right" : "left";
      ctx.fillText(time.name, x + (left ? -4 : 4) * devicePixelRatio, y);
    }
    ctx.restore();
  }

  function drawAllTimes(plot) {
    const faint = { colour: colour("--faint"), dash: [4, 4], stacked: false, rows_down: 0 };
    drawTimes(plot, samples.phases, faint);
    const warn = { colour: colour("--warn-ink"), dash: [1, 3], stacked: true, rows_down: 1 };
    const marks = [...(samples.marks ?? [])].sort((a, b) => a.time_s - b.time_s);
    drawTimes(plot, marks, warn);
  }

  function drawRegions(plot, regions) {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = colour("--region");
    for (const region of regions) {
      const left = plot.valToPos(region.from_s, "x", true);
      const right = plot.valToPos(region.to_s, "x", true);
      ctx.fillRect(left, bbox.top, Math.max(right - left, 2 * devicePixelRatio), bbox.height);
    }
    ctx.restore();
  }

  function axis(label) {
    const grid = { stroke: colour("--line"), width: 1 };
    const values = (_, ticks) => ticks.map(shown);  // uPlot's own rounds 0.0001 to 0
    return { label, values, stroke: colour("--ink"), grid, ticks: grid, labelSize: 22 };
  }

  function draw(description, box) {
    const series = description.series.map((line, index) => ({
      label: line.label,
      stroke: colours[index % colours.length],
      dash: line.band ? [2, 3] : index < colours.length ? undefined : [6, 4],
      width: line.band ? 1 : 1.5,
      spanGaps: description.span_gaps === true,
      paths: line.step ? uPlot.paths.stepped({ align: 1 }) : undefined,
      value: (_, value) => shown(value),
    }));
    const label = description.axis + (description.unit ? ` [${description.unit}]` : "");
    const options = {
      width: box.clientWidth,
      height: plotHeight_px,
      scales: { x: { time: false } },
      cursor: { sync: { key: "time" } },
      axes: [axis("time [s]"), { ...axis(label), size: axisWidth_px }],
      series: [{ label: "time", value: (_, value) => shown(value) }, ...series],
      hooks: {
        drawClear: [(plot) => drawRegions(plot, description.regions ?? [])],
        drawAxes: [drawAllTimes],
      },
    };
    const data = [description.time_s ?? samples.time_s, ...description.series.map((line) => line.values)];
    return new uPlot(options, data, box);
  }

  const boxes = [...document.querySelectorAll(".plot .canvas")];
  let drawn = [];
  function drawAll() {
    for (const plot of drawn) plot.destroy();
    drawn = boxes.map((box, index) => draw(samples.plots[index], box));
  }

  drawAll();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawAll);
  const fitAll = () => {
    drawn.forEach((plot, index) => plot.setSize({ width: boxes[index].clientWidth, height: plotHeight_px }));
  };
  addEventListener("resize", fitAll);
  // What is folded away has no width.
  for (const fold of document.querySelectorAll("details")) fold.addEventListener("toggle", fitAll);
  // Paper is white whatever the screen is; plots are pixels, so they are drawn anew for it.
  const setPrinting = (printing) => {
    document.documentElement.classList.toggle("printing", printing);
    drawAll();
  };
  addEventListener("beforeprint", () => setPrinting(true));
  addEventListener("afterprint", () => setPrinting(false));
})();
