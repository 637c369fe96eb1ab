"""Looking at motion: plots of trajectories and a page that plays a mouth."""
