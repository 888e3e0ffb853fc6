"""The stages of the tracker in order: a grey image, candidates, gradient, fit, score, judgement."""

from tracker.pipeline.tracker import Tracker

__all__ = ["Tracker"]
