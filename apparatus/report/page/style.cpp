#include "apparatus/report/page/style.hpp"

namespace tremie::report {

// Blue, orange, green and purple of Okabe and Ito's palette, which colour-blind readers tell apart; lighter in the dark.
const char* const style_sheet = R"css(
:root{color-scheme:light dark;--ink:#1c2126;--soft:#56616b;--line:#d5dade;--paper:#fff;--panel:#f4f6f7;
--c0:#0067a5;--c1:#c25400;--c2:#00785a;--c3:#9a4f8a;--band:#e6e9ec;--bad:#a51d1d;--good:#00654b}
@media (prefers-color-scheme:dark){:root{--ink:#e6e9ec;--soft:#a2adb7;--line:#3b444c;--paper:#14181b;--panel:#1e2429;
--c0:#56b4e9;--c1:#f0a03c;--c2:#35c79a;--c3:#d79bc8;--band:#2b3339;--bad:#ff8a80;--good:#5fd3ae}}
*{box-sizing:border-box}
body{font:1rem/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:var(--ink);background:var(--paper);
max-width:66rem;margin:0 auto;padding:1.2rem 1rem 2rem;overflow-wrap:break-word}
h1{font-size:1.55rem;line-height:1.25;margin:.2rem 0 .6rem;font-weight:650}
h2{font-size:1.1rem;margin:1.6rem 0 .4rem}
p{margin:.4rem 0;max-width:48rem}
.verdict{font-size:1.12rem;padding-left:.7rem;border-left:.3rem solid var(--line)}
.verdict.agrees{border-color:var(--good)}.verdict.differs{border-color:var(--c1)}
.bad{color:var(--bad);font-weight:600}
.soft,figcaption,.key{color:var(--soft)}
.figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,27rem),1fr));gap:.6rem 1.6rem}
figure{margin:.6rem 0;break-inside:avoid}
figure svg,canvas{display:block;width:100%;height:auto}
figure svg{max-height:28rem}
figcaption{font-size:.88rem;margin-top:.2rem}
svg text{fill:var(--ink)!important;font-family:system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
svg .soft{fill:var(--soft)!important}
svg .grid{stroke:var(--line)!important}svg .axis{stroke:var(--soft)!important}svg .band{fill:var(--band)!important}
svg .l0{stroke:var(--c0)!important}svg .l1{stroke:var(--c1)!important}svg .l2{stroke:var(--c2)!important}
svg .l3{stroke:var(--c3)!important}svg .f0{fill:var(--c0)!important}svg .f1{fill:var(--c1)!important}
svg .f2{fill:var(--c2)!important}svg .f3{fill:var(--c3)!important}svg .level{stroke:var(--ink)!important}
svg .hole{fill:var(--paper)!important}
svg .body{fill:var(--c0)!important}svg .wall{stroke:var(--ink)!important}svg .solid{fill:var(--ink)!important}
.tables{columns:27rem 2;column-gap:2.4rem}
.tables>section{break-inside:avoid}
.tables>section>h2{margin-top:.6rem}
table{border-collapse:collapse;width:100%;font-size:.94rem}
td,th{padding:.22rem .5rem .22rem 0;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}td:last-child:not(.n){overflow-wrap:anywhere}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums;padding-right:0}
.key{font-size:.76rem;display:block;overflow-wrap:anywhere;font-family:ui-monospace,"DejaVu Sans Mono",monospace}
.wide{overflow-x:auto}.wide td,.wide th{padding-right:1.1rem}.wide td.n{white-space:normal}.wide td:first-child{min-width:8rem}
.wide th{white-space:normal;overflow-wrap:break-word;min-width:4.5rem}
pre{background:var(--panel);padding:.7rem .9rem;overflow-x:auto;font-size:.82rem;white-space:pre-wrap;overflow-wrap:anywhere}
.controls{display:flex;flex-wrap:wrap;gap:.4rem .8rem;align-items:center;margin:.4rem 0}
.controls input[type=range]{flex:1 1 10rem;min-width:8rem;accent-color:var(--c0)}
button,select{font:inherit;color:inherit;background:var(--panel);border:1px solid var(--line);border-radius:.3rem;padding:.25rem .8rem}
canvas{background:var(--panel);border-radius:.3rem}
@media (max-width:500px){.wide table{font-size:.8rem}.wide td,.wide th{padding-right:.5rem}.wide td:first-child{min-width:6rem}
.wide th{min-width:0}}
@page{size:A4;margin:13mm 14mm}
@media print{:root{color-scheme:light;--ink:#000;--soft:#444;--line:#bbb;--paper:#fff;--panel:#f4f6f7;--c0:#0067a5;--c1:#c25400;
--c2:#00785a;--c3:#9a4f8a;--band:#e6e9ec}
body{font-size:8.6pt;line-height:1.35;padding:0;max-width:none}figcaption{font-size:7.5pt}.verdict{font-size:10.5pt}h1{font-size:14pt}h2{font-size:10pt;margin:.5rem 0 .15rem}
.controls,.screen{display:none}.figures{grid-template-columns:1fr 1fr;gap:0 6mm}figure{margin:.2rem 0}figure svg{max-height:52mm}
canvas{max-height:48mm;width:auto;max-width:100%}
.tables{columns:2;column-gap:8mm}td,th{padding:.06rem .4rem .06rem 0}.key{font-size:.8em;line-height:1.1}
details:not([open]){display:none}pre{font-size:6.5pt}}
)css";

}  // namespace tremie::report
