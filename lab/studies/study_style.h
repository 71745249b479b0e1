// SPDX-License-Identifier: BSD-3-Clause
// The style of report.html: on a light or a dark screen, narrow or wide, and on paper.
#pragma once

namespace ergocast {

inline constexpr const char* kPageStyle = R"(
:root{--ink:#1d2127;--soft:#5b6470;--line:#dfe3e8;--page:#fff;--card:#f6f7f9;
--good:#0b7a4b;--odd:#9a6200;--bad:#b3261e;color-scheme:light dark}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);
font:15px/1.5 system-ui,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
main{max-width:1200px;margin:0 auto;padding:28px 24px 48px}
header p{margin:0;color:var(--soft)}
h1{font-size:28px;line-height:1.2;margin:2px 0 14px;overflow-wrap:anywhere}
sub,sup{line-height:0}
h2{font-size:19px;margin:40px 0 10px}
.result{padding:9px 14px;border-left:5px solid var(--odd);background:var(--card);color:var(--ink);
border-radius:0 6px 6px 0;overflow-wrap:anywhere}
.result b{color:var(--odd)}
.done{border-color:var(--good)}.done b{color:var(--good)}
.failed{border-color:var(--bad)}.failed b{color:var(--bad)}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(145px,1fr));gap:12px;margin:18px 0}
.cards div:first-child{grid-column:span 2}
.cards div{background:var(--card);border-radius:8px;padding:10px 14px}
.cards dt{color:var(--soft);font-size:13px}
.cards dd{margin:0;font-size:19px;font-weight:600;font-variant-numeric:tabular-nums}
.facts{display:grid;grid-template-columns:max-content 1fr;gap:3px 18px;margin:0}
.facts div{display:contents}.facts dt{color:var(--soft)}.facts dd{margin:0;overflow-wrap:anywhere}
.figures{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:34px 24px;margin-top:30px;
grid-auto-flow:dense}
figure{margin:0;min-width:0}
figure.wide{grid-column:1/-1}
figure h2{margin:0 0 6px;font-size:17px}
figure svg{display:block;max-width:100%;height:auto;margin:0 auto}
figcaption{color:var(--soft);font-size:14px;margin-top:6px}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;white-space:nowrap}
th,td{padding:5px 14px 5px 0;border-bottom:1px solid var(--line);text-align:right}
th{color:var(--soft);font-weight:500;font-size:13px}
th.text,td.text{text-align:left}
.dot{display:inline-block;width:10px;height:10px;border-radius:5px;margin-right:7px}
code,pre{font:13px/1.6 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
pre{background:var(--card);border-radius:8px;padding:12px 16px;overflow-x:auto;margin:8px 0}
@media screen and (max-width:900px){.figures{grid-template-columns:minmax(0,1fr)}
.wide svg{max-width:none}}
@media (prefers-color-scheme:dark) and (not print){
:root{--ink:#e6e8eb;--soft:#a2abb6;--line:#343a43;--page:#15181c;--card:#1f242a;
--good:#4cc38a;--odd:#e5a83b;--bad:#ff8a80}
figure svg text{fill:#d5d9de}figure svg .tick,figure svg .note{fill:#a9b1bb}
figure svg .paper{fill:none}figure svg .frame,figure svg .mark{stroke:#8b94a0}
figure svg .grid{stroke:#2b3138}figure svg .fine{stroke:#20252b}
figure svg .limit{stroke:#d5d9de}figure svg .team{stroke:#fff}
figure svg .main{stroke:#56b4e9}
figure svg .halo{stroke:#15181c}figure svg .onmap{fill:#222;stroke:#fff}}
@media print{body{font-size:12px}main{padding:0;max-width:none}
*{print-color-adjust:exact;-webkit-print-color-adjust:exact}
.figures{display:block}figure{break-inside:avoid;margin-bottom:18px}
figure svg{max-height:86mm}figcaption{font-size:11px}
.scroll{overflow:visible}pre{white-space:pre-wrap}tr,.cards div{break-inside:avoid}h2{break-after:avoid}
table,th{font-size:9px}th,td{padding:3px 7px 3px 0}}
)";

}  // namespace ergocast
