"""A trained model, and its integer tables, which the C library reads."""
