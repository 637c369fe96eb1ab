fit = None
