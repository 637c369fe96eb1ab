"""Labial's exporter: trains lip-motion models and writes them as tables for the C library."""

__version__ = "0.2.0"
