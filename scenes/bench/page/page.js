// SPDX-License-Identifier: MIT
// Puts the parts into the page.

function showHead() {
  const { conditions, machine } = result;
  byId("lead").append(
    `How far ${methodNames.length} ways to make a ${conditions.output.width}×${conditions.output.height} picture from a smaller frame are from the truth, and what each costs: `,
    `${sceneNames.length} ${sceneNames.length === 1 ? "scene" : "scenes"} at ${scales.length} ${scales.length === 1 ? "scale" : "scales"} on ${machine.cl_device} (${machine.cl_platform}), ${result.date}.`);
  for (const finding of page.findings) {
    byId("findings").append(el("div", { class: "finding" }, el("b", {}, finding.figure), el("strong", {}, finding.heading), el("p", {}, finding.sentence)));
  }
}

function startPlots() {
  const scene = byId("plot-scene");
  const scale = byId("plot-scale");
  const measure = byId("plot-measure");
  options(scene, sceneEntries("mean of all"), firstScene);
  options(scale, scales.map((s) => [s, s]), headlineScale);
  options(measure, page.measures.map((m) => [m.name, m.label]), "flip");
  const draw = () => {
    hideTip();
    drawPlot(byId("plot"), scene.value, Number(scale.value), measure.value);
    drawSmallPlots(byId("small-plots"), { scene: scene.value, scale: Number(scale.value) }, measure.value, (s, at) => {
      scene.value = s;
      scale.value = at;
      draw();
      byId("error").scrollIntoView({ block: "start" });
    });
  };
  for (const select of [scene, scale, measure]) select.addEventListener("change", draw);
  return draw;
}

function startFrames() {
  const scene = byId("frame-scene");
  const clock = byId("frame-clock");
  options(scene, sceneEntries("mean of all"), firstScene);
  const rows = seventyRows();
  byId("frame-lead").append(`A whole frame with ${result.frames[0].method}: OpenGL draws it, it is handed to OpenCL, resolved, presented and handed back; one step after the other, nothing overlaps.`);
  if (rows.length > 0) {
    byId("seventy-title").append(`At scale ${headlineScale}: what remains of the frame time at 1`);
    byId("seventy-lead").append("Below one, a smaller viewport pays; the dashed line is the part of the pixels that is left to draw.");
  }
  const draw = () => {
    hideTip();
    drawFrames(byId("frame-plot"), scene.value, clock.value);
    if (rows.length > 0) drawSeventy(byId("seventy-plot"), rows);
  };
  for (const select of [scene, clock]) select.addEventListener("change", draw);
  return draw;
}

function startTables() {
  const selects = { scene: byId("table-scene"), scale: byId("table-scale"), method: byId("table-method") };
  options(selects.scene, [["", "all"], ...sceneNames.map((name) => [name, name])], "");
  options(selects.scale, [["", "all"], ...scales.map((s) => [s, s])], scales.length > 1 ? headlineScale : "");
  options(selects.method, [["", "all"], ...methodNames.map((name) => [name, name])], "");
  const rows = makeRowsTable();
  const filter = () => rows.show((row) => Object.entries(selects).every(([field, select]) => select.value === "" || String(row[field]) === select.value));
  for (const select of Object.values(selects)) select.addEventListener("change", filter);
  filter();
  byId("rows-table").append(rows.node);
  byId("frames-table").append(makeFramesTable().node);
  byId("copies-table").append(makeCopiesTable().node);
  byId("scenes-table").append(makeScenesTable().node);
  byId("methods-table").append(makeMethodsTable().node);
}

function startViewer() {
  if (page.gallery.scenes.length === 0) {
    byId("pictures").hidden = true;
    document.querySelector('nav a[href="#pictures"]').remove();
    return;
  }
  const { width, height, frame } = page.gallery;
  byId("pictures-lead").append(
    `${width}×${height} pixels of measured frame ${frame + 1}, where the methods err most in the mean, as they are: no scaling. Tone mapped as the errors are measured. Error maps show FLIP.`);
  new Gallery(byId("viewer"));
}

function showFacts() {
  const { machine, conditions } = result;
  const facts = [
    ["command", el("code", {}, result.command)],
    ["when", `${result.date}, ${number(result.wall_seconds / 60)} minutes; version ${result.version}`],
    ["OpenCL", `${machine.cl_device}; ${machine.cl_platform} ${machine.cl_driver}, ${machine.cl_version}`],
    ["OpenGL", `${machine.gl_renderer}; ${machine.gl_version}`],
    ["handed over by", machine.interop],
    ["machine", `${machine.processor}, ${machine.processors} processors, ${number(machine.memory_gib)} GiB; ${machine.system}`],
    ["load", `${number(machine.load_before)} before, ${number(machine.load_after)} after (processes that wanted to run, of the last minute)`],
    ["noise", `typical half width of a median's 95 % interval: ±${(100 * page.noise.cost).toFixed(1)} % of costs in copies, ±${(100 * page.noise.ms).toFixed(1)} % of milliseconds; ± in the tables is that of each`],
    ["frames", `${conditions.frames} measured after ${conditions.warm_up} that warm up, or ${conditions.history_warm_up ?? conditions.warm_up} of methods that accumulate; then ${conditions.rounds} timed rounds of ${conditions.frames} that follow on them; ${conditions.fps} a second from ${conditions.start} s, of a scene with cuts from its first one on; seed ${conditions.seed}`],
    ["order", "every frame is drawn once for each jitter, then each method resolves it, another going first each time, with one plain copy among them; truth and errors are computed outside of the timing"],
    ["truth", `${conditions.truth_samples}×${conditions.truth_samples} samples a pixel in a box, by the same renderer`],
    ["cost", `by ${page.cost_clock}, the steadier clock on this device, in copies of the picture: float4, read and written once`],
  ];
  byId("facts").append(...facts.flatMap(([term, text]) => [el("dt", {}, term), el("dd", {}, text)]));
  const words = [
    ["FLIP", "mean difference that an observer sees when both pictures are shown in turn, 67 pixels a degree (Andersson et al. 2020); 0 is equal"],
    ["PSNR", "of tone-mapped colour, max(c, 0)/(1 + c), sRGB encoded; over frames, that of the mean squared error. The linear one clips light to 0..1"],
    ["SSIM", "of tone-mapped luma, Gaussian windows of 11×11 (Wang et al. 2004); 1 is equal"],
    ["relative HDR error", "mean of (c − t)²/(t² + 0.01) over linear colour, whatever the exposure (Rousselle et al. 2011)"],
    ["99th percentile", "of |picture − truth| over tone-mapped colour values"],
    ["worst 16×16 window", "largest root mean square error of any 16×16 pixels in any frame, tone mapped"],
    ["flicker", "mean change of luma from frame to frame that the truth does not have; the truth's own change stands in the table of scenes"],
    ["ghosting", "root mean square error of the pixels that were hidden behind something nearer within the last two frames, by the true depth and velocity"],
    ["regions", "each pixel is in one: thin things (less than four pixels across), else within four pixels behind one, else disoccluded, else within two pixels of where two motions meet, else the rest; by the true depth and velocity"],
    ["×", "the plain copy's time in the same round; its bandwidth stands in its own table"],
  ];
  byId("words").append(...words.flatMap(([term, text]) => [el("dt", {}, term), el("dd", {}, text)]));
}

showHead();
const drawings = [startPlots(), startFrames()];
startTables();
startViewer();
showFacts();

const drawAll = () => drawings.forEach((draw) => draw());
let drawnWidth = 0;
new ResizeObserver(() => {
  if (document.body.clientWidth === drawnWidth) return;
  drawnWidth = document.body.clientWidth;
  // Later: drawing changes the height, and an observer must not resize what it observes.
  requestAnimationFrame(drawAll);
}).observe(document.body);
