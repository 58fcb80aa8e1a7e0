#pragma once
// The style sheet of a report: light, dark, narrow and on paper.

#include <string_view>

namespace lacedring::app {

inline constexpr std::string_view kReportStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #fff; --text: #1b1f24; --soft: #57606a; --line: #d0d7de; --faint: #eaeef2; --band: #f6f8fa;
  --ours: #1a66b8; --paper: #b35900; --baseline: #7d8590; --outside: #8a6d1d; --link: #0a58ae;
  --shade: rgba(27, 31, 36, .22);
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #14171b; --text: #e4e7eb; --soft: #a2abb5; --line: #3b434d; --faint: #262c33; --band: #1b2026;
    --ours: #58a6ff; --paper: #f0a04b; --baseline: #848d97; --outside: #c9a63f; --link: #79b8ff;
    --shade: rgba(160, 180, 205, .34);
  }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1240px; padding: 24px 24px 40px; background: var(--page); color: var(--text);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 1.4rem; line-height: 1.25; margin: 48px 0 8px; padding-top: 14px; border-top: 2px solid var(--line); }
h3 { font-size: 1.1rem; margin: 30px 0 6px; }
h1, h2, .made code, .path { overflow-wrap: anywhere; }
p { margin: 0 0 8px; max-width: 84ch; }
a { color: var(--link); }
code { font: .92em ui-monospace, "DejaVu Sans Mono", monospace; }
.note, .path, figcaption, .made { color: var(--soft); font-size: .9rem; }
b { color: var(--text); }
.facts { margin: 8px 0 0; padding: 0; list-style: none; display: flex; flex-wrap: wrap; gap: 0 26px; }
.facts + .note { margin: 4px 0 16px; }
.wide { overflow-x: auto; margin: 6px 0; background:
    linear-gradient(90deg, var(--page) 30%, transparent) left / 48px 100% no-repeat local,
    linear-gradient(270deg, var(--page) 30%, transparent) right / 48px 100% no-repeat local,
    linear-gradient(90deg, var(--shade), transparent) left / 18px 100% no-repeat scroll,
    linear-gradient(270deg, var(--shade), transparent) right / 18px 100% no-repeat scroll; }
.wide:focus-visible { outline: 2px solid var(--link); outline-offset: 2px; }
table { border-collapse: separate; border-spacing: 0; font-size: .88rem; font-variant-numeric: tabular-nums; }
table.sizes, table.overview { width: 100%; }
th, td { padding: 4px 7px; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--faint); }
thead th { color: var(--soft); font-weight: 600; border-bottom: 1px solid var(--line); vertical-align: bottom; }
tbody th, th.left, td.left { text-align: left; }
tbody th { font-weight: 600; background: var(--page); position: sticky; left: 0; }
td.left { color: var(--soft); }
td.what { white-space: normal; min-width: 13em; }
.tag { border: 1px solid var(--line); border-radius: 3px; padding: 0 4px; font-size: .85em; }
td.strong { font-weight: 650; }
tr.ours th { color: var(--ours); } tr.paper th { color: var(--paper); }
tbody tr:hover td, tbody tr:hover th { background: var(--band); }
tr.sum td, tr.sum th { border-top: 1px solid var(--line); color: var(--soft); }
th.name { white-space: normal; overflow-wrap: break-word; min-width: 9em; max-width: 20em; }
.overview th, .overview td { padding: 4px 3px; }
.overview thead th { white-space: normal; } .overview [scope=colgroup] { text-align: center; }
figure { margin: 0; }
.bars ul { list-style: none; margin: 0; padding: 0; }
.bars .key { display: flex; flex-wrap: wrap; gap: 2px 20px; margin: 6px 0 10px; font-size: .86rem; }
.swatch { display: inline-block; width: .85em; height: .85em; margin-right: .45em; border-radius: 2px;
  vertical-align: -.06em; border: 1px solid var(--soft); }
.swatch.ours, .track .ours { background: var(--ours); }
.swatch.paper, .track .paper { background: var(--paper); }
.swatch.baseline, .track .baseline { background: var(--baseline); }
.chart { position: relative; font-size: .86rem; --name: 11.5rem; --value: 4rem; }
.chart li { display: flex; align-items: center; height: 24px; position: relative; }
.chart .name { flex: 0 0 var(--name); overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.chart .track { flex: 1; }
.chart .track i { display: block; height: 14px; border-radius: 0 2px 2px 0; }
.chart .value { flex: 0 0 var(--value); text-align: right; font-variant-numeric: tabular-nums; }
.lines, .axis { padding-left: var(--name); padding-right: var(--value); }
.lines { position: absolute; inset: 0 0 20px 0; }
.lines div, .axis div { position: relative; height: 100%; }
.lines i { position: absolute; top: 0; bottom: 0; border-left: 1px solid var(--line); }
.axis { height: 20px; }
.axis i { position: absolute; transform: translateX(-50%); font-style: normal; color: var(--soft); font-size: .78rem; }
.panels, .pictures { display: grid; gap: 18px; grid-template-columns: repeat(auto-fit, minmax(min(320px, 100%), 1fr)); }
.panel figcaption { font-weight: 600; color: var(--text); }
svg { display: block; width: 100%; height: auto; }
svg .grid { stroke: var(--line); stroke-width: 1; }
svg text { fill: var(--soft); font: 10px system-ui, "DejaVu Sans", sans-serif; }
svg .x { text-anchor: middle; } svg .y { text-anchor: end; }
svg .inside { fill: var(--ours); } svg .outside { fill: var(--outside); }
details { margin-top: 8px; } summary { cursor: pointer; color: var(--link); font-size: .9rem; }
.pictures img { display: block; width: 100%; height: auto; border-radius: 6px; border: 1px solid var(--line); }
.pictures figcaption { margin-top: 6px; }
.pictures figcaption b { display: block; }
.legend { white-space: nowrap; }
.ramp { display: inline-block; width: 4.5em; height: .8em; border-radius: 2px; vertical-align: -.06em;
  background: linear-gradient(90deg, #3b52ba, #309bdb, #cce3dc, #f6b562, #c0282f); }
footer { margin-top: 48px; padding-top: 12px; border-top: 2px solid var(--line); }
.made dt { float: left; clear: left; min-width: 6.5em; } .made dd { margin: 0 0 2px 6.5em; }
@media (max-width: 1250px) {
  table { font-size: .8rem; } th, td { padding: 4px; }
  table.sizes td.left { white-space: normal; min-width: 6.5em; } table.sizes td.what { min-width: 11em; }
}
@media (max-width: 800px) { table.sizes td.left { white-space: nowrap; } }
@media (max-width: 640px) {
  body { padding: 16px 14px 32px; }
  .chart { --name: 9.2rem; --value: 3.3rem; font-size: .8rem; }
  .axis .odd { display: none; }
  .made dt { float: none; } .made dd { margin-left: 0; }
}
@media print {
  @page { margin: 14mm; }
  :root { font-size: 12px; color-scheme: light; --page: #fff; --text: #000; --soft: #444; --line: #bbb; --faint: #ddd; --band: #fff;
    --ours: #1a66b8; --paper: #b35900; --baseline: #7d8590; --outside: #8a6d1d; --link: #000; }
  body { max-width: none; padding: 0; font-size: 9.5pt; }
  svg text { font-size: 11px; } h3 { margin-top: 18px; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  a { text-decoration: none; }
  .wide { overflow: visible; background: none; }
  table { font-size: 7pt; } th, td { padding: 2px 3px; } td.what { font-size: 6pt; }
  .offsets th, .offsets td { padding: 0 4px; } table.sizes { break-inside: avoid; }
  tbody th { position: static; }
  .chart { --name: 13rem; } .chart li { height: 16px; } .chart .track i { height: 10px; }
  .panels, .pictures { grid-template-columns: repeat(3, 1fr); gap: 8px; }
  .pictures figcaption { font-size: 7.5pt; } .legend { white-space: normal; }
  figure, tr, .facts { break-inside: avoid; }
  h2, h3, summary { break-after: avoid; }
  section + section { break-before: page; } section > h2 { margin-top: 12px; }
  details::details-content { content-visibility: visible; height: auto; display: block; }
}
)css";

}  // namespace lacedring::app
