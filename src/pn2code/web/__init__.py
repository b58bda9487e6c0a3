"""A local web server for pages of pn2code: who may ask, and how it begins and ends. It knows nothing of nets."""
