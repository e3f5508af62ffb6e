// The look of a report: light, dark and on paper.
#pragma once

namespace ibrdf {

// A style sheet without <, > or &, so that it is the same in HTML and in XML.
inline constexpr char kReportStyle[] = R"(
:root {
  color-scheme: light dark;
  --ground: #fff; --text: #1b1d20; --faint: #5c6370; --line: #d5d9df;
  --warn-ground: #fff6e0; --warn-line: #d9a520;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ground: #16181c; --text: #e4e6ea; --faint: #9aa3b0; --line: #363b44;
    --warn-ground: #2e2714; --warn-line: #b98a1c;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0; background: var(--ground); color: var(--text);
  font: 16px/1.5 system-ui, sans-serif;
}
main { max-width: 1080px; margin: 0 auto; padding: 24px 20px 48px; }
h1 { font-size: 1.7em; margin: 0; overflow-wrap: anywhere; }
h2 {
  font-size: 1.25em; margin: 1.9em 0 0.4em; padding-bottom: 0.2em;
  border-bottom: 1px solid var(--line);
}
h3 { font-size: 1em; margin: 1.2em 0 0.3em; }
p { margin: 0.5em 0; max-width: 75ch; }
.summary, figcaption, footer { color: var(--faint); }
.verdict { margin-top: 0.8em; font-size: 1.08em; }
.warnings {
  margin-top: 1.2em; padding: 0.6em 1em; background: var(--warn-ground);
  border-left: 4px solid var(--warn-line);
}
.warnings h2 { margin: 0; border: 0; font-size: 1em; }
.warnings ul { margin: 0.3em 0 0; padding-left: 1.2em; }
.figures { display: flex; flex-wrap: wrap; gap: 18px; align-items: flex-end; }
figure { margin: 0; flex: 1 1 220px; max-width: 330px; align-self: flex-start; }
figure.wide { flex-basis: 440px; max-width: 511px; }
img { display: block; width: 100%; height: auto; }
img.pixels { image-rendering: pixelated; }
figcaption { font-size: 0.85em; margin-top: 0.3em; line-height: 1.35; }
.bar { height: 12px; margin-top: 6px; border: 1px solid var(--line); }
.labels {
  display: flex; justify-content: space-between; font-size: 0.8em;
  color: var(--faint);
}
table { border-collapse: collapse; margin: 0.5em 0; font-size: 0.92em; }
td, th {
  text-align: left; vertical-align: top; padding: 0.25em 1em 0.25em 0;
  border-bottom: 1px solid var(--line); overflow-wrap: anywhere;
}
th { font-weight: 600; overflow-wrap: normal; }
td:first-child { overflow-wrap: normal; }
.number { font-variant-numeric: tabular-nums; white-space: nowrap; }
.plots { display: flex; flex-wrap: wrap; gap: 18px; }
.plot { flex: 1 1 440px; max-width: 511px; }
svg { display: block; width: 100%; height: auto; }
footer { margin-top: 2.5em; font-size: 0.85em; }
@media print {
  :root {
    color-scheme: light;
    --ground: #fff; --text: #000; --faint: #444; --line: #bbb;
    --warn-ground: #fff; --warn-line: #000;
  }
  body { font-size: 10pt; }
  main { max-width: none; padding: 0; }
  img, .bar { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  figure, tr, .plot, .warnings { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  figure { max-width: 30%; flex-basis: 28%; }
  figure.wide { max-width: 48%; flex-basis: 46%; }
  .plot { flex-basis: 46%; max-width: 49%; }
}
)";

}  // namespace ibrdf
