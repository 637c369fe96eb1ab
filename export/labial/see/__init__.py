"""Plots of trajectories, and a page that plays a mouth."""
