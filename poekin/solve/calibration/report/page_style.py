"""The page of a calibration without what is in it: its frame and its looks."""

from __future__ import annotations

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
$style</style>
</head>
<body>
<h1>$title</h1>
<p class="lead">$lead</p>
$sections
</body>
</html>
"""

STYLE = """:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 64rem; padding: 2rem 1.25rem 4rem; color: #1a1a1a; background: #fff;
  font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .25rem; overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; margin: 2.5rem 0 .5rem; padding-top: .75rem; border-top: 2px solid #1a1a1a; }
p { max-width: 46rem; margin: .5rem 0; overflow-wrap: anywhere; }
.lead { font-size: 1.15rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: .5rem 0 1.25rem; font-size: .88rem; min-width: 55%; }
th { text-align: left; font-weight: 600; border-bottom: 1.5px solid #1a1a1a; padding: .3rem .6rem;
  vertical-align: bottom; }
td { padding: .3rem .6rem; border-bottom: 1px solid #ddd; vertical-align: top; }
th.number { text-align: right; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
figure { margin: 1rem 0; }
figure svg { max-width: 100%; height: auto; }
figcaption, .caption { font-size: .88rem; color: #333; font-weight: 600; margin: 1rem 0 .25rem; }
figcaption { margin-top: .25rem; }
summary { cursor: pointer; font-weight: 600; font-size: .88rem; }
@media print { body { max-width: none; padding: 0; font-size: 11px; }
  details:not([open]) > *:not(summary) { display: revert; } }
"""
