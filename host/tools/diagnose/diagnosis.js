// SPDX-License-Identifier: MIT
// What is wrong with the input of a sequence: a table, and the frames that it foretells worst.

const kKinds = ["picture", "error"];

function row(finding) {
  const isWrong = finding.verdict === "wrong";
  const known = finding.margin_db > 0;
  return el("tr", {}, ...[
    finding.subject, isWrong ? el("b", {}, finding.verdict) : finding.verdict, finding.says, finding.fits,
    el("code", {}, finding.option), known ? `${number(finding.margin_db)} dB` : "",
    known ? `${Math.round(Math.min(finding.certainty, 99))} s.e.` : "",
    finding.share > 0 ? `${Math.round(100 * finding.share)} %` : "", finding.not_shown.join(", "),
  ].map((content) => el("td", {}, content)));
}

function showPictures() {
  const host = el("div", { id: "viewer" });
  section("pictures", "Where the input's word fails", quiet(el("b", {}, "error"),
    " is how far the frame before, moved as the input says, lies from what is seen. Thin rims are what came into view; whole surfaces are wrong input, or light that moves otherwise than they do."), host);
  const { frames } = page.pictures;
  new PictureViewer(host, {
    size: page.pictures,
    selects: [["Frame", "frame", frames.map((one, i) => [i, one.index]), 0]],
    choices: kKinds.map((kind, i) => [i, kind]), shown: [0, 1],
    picture: (kind, [frame]) => decode(frames[frame].pngs[kind], kind === "1"),
    caption: (kind, [frame]) => [el("b", {}, kKinds[kind]), kind === "1" ? `mean ${number(frames[frame].mean)}` : ""],
    legend: ["0", "0.15 of the light on the screen"],
  });
}

const wrong = page.diagnosis.findings.filter((finding) => finding.verdict === "wrong");
document.title = "Is the input right?";
head("Is the input right?", `${page.input}: ${wrong.length ? `${wrong.map((finding) => finding.subject).join(", ")} wrong.` : "nothing wrong."}`);
const titles = ["looked at", "", "input says", "fits", "mends it", "margin", "certainty", "share", "not shown by these frames"];
section("findings-table", "What the frames say", el("div", { class: "table" }, el("table", {},
  el("thead", {}, el("tr", {}, ...titles.map((title) => el("th", {}, title)))),
  el("tbody", { id: "found" }, ...page.diagnosis.findings.map(row)))));
if (page.pictures) showPictures();
