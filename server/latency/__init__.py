"""Latency from the scene to the page, measured with codes on a screen in view of the camera.

codes.py        bit patterns of the codes drawn by the page, and their durations
code_reader.py  detection of the code in an image
clocks.py       conversion of server times to page times by round trips
statistics.py   median, 99th percentile and stages from times of painting, capture and display; pure
record.py       record of a result
"""

from server.latency.clocks import ClockComparison
from server.latency.code_reader import CodeReader
from server.latency.codes import CELLS, CodePlan, code_patterns, plan_codes
from server.latency.record import LatencyReport, LatencyResult, Screen
from server.latency.statistics import PaintedCode, ReadImage, ShownImage, Stage, latency_report

__all__ = [
    "CELLS",
    "ClockComparison",
    "CodePlan",
    "CodeReader",
    "LatencyReport",
    "LatencyResult",
    "PaintedCode",
    "ReadImage",
    "Screen",
    "ShownImage",
    "Stage",
    "code_patterns",
    "latency_report",
    "plan_codes",
]
