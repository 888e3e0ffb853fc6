"""Coaxial's server: owns time, threads, processes, files and the network, and computes no geometry."""
