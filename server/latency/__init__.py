"""Latency from the scene to the page, measured with codes on a screen in view of the camera.

codes.py        the codes: the bit patterns that a page draws, and how long each of them stays
reading.py      the code in an image
clocks.py       the server's clock on the page's time axis, from questions and answers
statistics.py   median, 99th percentile and stages from times of painting, capture and showing; pure
record.py       a result as it is stored
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
