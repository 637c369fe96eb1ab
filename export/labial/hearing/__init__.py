"""Lips from sound alone: the front end, the network, its model, and the model's integer tables as C."""
