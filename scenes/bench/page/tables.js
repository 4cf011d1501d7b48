// SPDX-License-Identifier: MIT
// The tables of the page of speed against error.

const kCaseColumns = [
  textColumn("scene", (row) => row.scene),
  numberColumn("scale", (row) => row.scale, (row) => String(row.scale)),
];
const renderColumn = numberColumn("render", (row) => row.render.width * row.render.height, (row) => `${row.render.width}×${row.render.height}`);
const caseOf = (row) => `${row.scene}|${row.scale}`;

function makeRowsTable() {
  const errors = page.measures.map((measure) => numberColumn(
    measure.label, (row) => errorOf(row, measure.name),
    (row) => number(errorOf(row, measure.name), isDecibels(measure.name) ? 4 : 3), measure.higher ? 1 : -1));
  const speed = (field) => (row) => row.speed[field].median;
  return makeTable([
    ...kCaseColumns, textColumn("method", (row) => row.method),
    numberColumn("ms, median", speed("ms"), (row) => `${number(row.speed.ms.median)} ${plusMinus(row.speed.ms)}`, -1),
    numberColumn("ms, p95", (row) => row.speed.ms.p95),
    numberColumn("× copy", speed("ratio"), null, -1),
    numberColumn("× copy, processor time", speed("processor_ratio"), (row) => `${number(row.speed.processor_ratio.median)} ${plusMinus(row.speed.processor_ratio)}`, -1),
    ...errors,
    numberColumn("non-finite pixels", (row) => row.quality.non_finite, (row) => String(row.quality.non_finite)),
    numberColumn("MB", (row) => row.speed.bytes, (row) => number(row.speed.bytes / 1e6)),
    numberColumn("GB/s", (row) => row.speed.gigabytes_per_second),
    renderColumn, textColumn("kernels", (row) => row.speed.kernels),
  ], result.rows, caseOf);
}

function makeFramesTable() {
  const part = (title, field) => numberColumn(title, (row) => row[field].median, (row) => number(row[field].median));
  return makeTable([
    ...kCaseColumns, renderColumn, textColumn("method", (row) => row.method),
    part("draw, ms", "draw_ms"), part("interop, ms", "interop_ms"), part("resolve, ms", "resolve_ms"),
    numberColumn("frame, ms", (row) => row.frame_ms.median, (row) => `${number(row.frame_ms.median)} ${plusMinus(row.frame_ms)}`),
    numberColumn("p95", (row) => row.frame_ms.p95),
    part("processor: draw", "draw_processor_ms"), part("interop", "interop_processor_ms"), part("resolve", "resolve_processor_ms"),
    numberColumn("processor, frame", (row) => row.frame_processor_ms.median, (row) => `${number(row.frame_processor_ms.median)} ${plusMinus(row.frame_processor_ms)}`),
    numberColumn("moved, MB", (row) => row.interop_bytes, (row) => number(row.interop_bytes / 1e6)),
  ], result.frames);
}

function makeCopiesTable() {
  return makeTable([
    ...kCaseColumns,
    numberColumn("ms, median", (row) => row.ms.median, (row) => `${number(row.ms.median)} ${plusMinus(row.ms)}`),
    numberColumn("ms, p95", (row) => row.ms.p95), numberColumn("processor ms", (row) => row.processor_ms.median),
    numberColumn("GB/s", (row) => row.gigabytes_per_second),
  ], result.copies);
}

function makeScenesTable() {
  const part = (title, field) => numberColumn(
    title, (row) => row[field], (row) => (row[field] === null ? "" : `${number(100 * row[field])} %`));
  return makeTable([
    textColumn("scene", (row) => row.name), textColumn("what is seen", (row) => row.summary, true),
    textColumn("what it tests", (row) => row.reason, true),
    numberColumn("flicker of truth", (row) => row.truth_flicker),
    part("disoccluded", "disoccluded"),
    part("region: thin things", "part_thin"), part("behind thin things", "part_behind_thin"),
    part("disoccluded, no thin thing near", "part_disoccluded"), part("edges of motion", "part_edge"),
    part("rest", "part_rest"),
  ], result.scenes);
}

function makeMethodsTable() {
  return makeTable([
    textColumn("method", (row) => row.name), textColumn("what it does", (row) => row.summary, true),
    textColumn("jitter of its frames", (row) => row.jitter),
    numberColumn("bias of texture detail at scale 1", (row) => row.lod_bias,
      (row) => String(row.lod_bias)),
  ], result.methods);
}
