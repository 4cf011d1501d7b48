// SPDX-License-Identifier: MIT
// What is wrong with the input of a sequence: a table, and the frames that it foretells worst.

const kKinds = ["picture", "error"];

class FailureViewer extends PictureViewer {
  constructor(host) {
    const frame = el("select");
    super(host, page.pictures, [["Frame ", frame]], ["0", "0.15 of the light on the screen"]);
    this.number = frame;
    options(frame, page.pictures.frames.map((one, i) => [i, one.index]), 0);
    this.choices.forEach((choice, side) => options(choice, kKinds.map((kind, i) => [i, kind]), side));
    this.load();
  }

  async load() {
    const wanted = [this.number, ...this.choices].map((select) => Number(select.value));
    const frame = page.pictures.frames[wanted[0]];
    const pictures = await Promise.all(wanted.slice(1).map((kind) => decode(frame.pngs[kind]).then(kind ? paintMap : (picture) => picture)));
    // Another choice may have overtaken this one.
    if (wanted.some((value, i) => value !== Number([this.number, ...this.choices][i].value))) return;
    this.show(pictures, wanted.slice(1).map((kind) => [el("b", {}, kKinds[kind]), kind ? `mean ${number(frame.mean)}` : ""]));
  }
}

function row(finding) {
  const cells = [finding.subject, finding.verdict, finding.says, finding.fits, finding.option,
    ...(finding.margin_db > 0 ? [`${number(finding.margin_db)} dB`, `${Math.round(Math.min(finding.certainty, 99))} s.e.`] : ["", ""]),
    finding.share > 0 ? `${Math.round(100 * finding.share)} %` : "", finding.not_shown.join(", ")];
  return el("tr", {}, ...cells.map((text, i) => el("td", {}, finding.verdict === "wrong" && i === 1 ? el("b", {}, text) : i === 4 ? el("code", {}, text) : text)));
}

const wrong = page.diagnosis.findings.filter((finding) => finding.verdict === "wrong");
document.title = "Is the input right?";
byId("lead").append(`${page.input}: ${wrong.length ? `${wrong.map((finding) => finding.subject).join(", ")} wrong.` : "nothing wrong."}`);
byId("found").append(...page.diagnosis.findings.map(row));
if (page.pictures) {
  byId("pictures").hidden = false;
  new FailureViewer(byId("viewer"));
}
