"""The methods that are compared, each with ``fit(training)`` that returns a predictor."""
