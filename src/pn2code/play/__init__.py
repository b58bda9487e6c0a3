"""The token game in a browser: sessions of a net in play, and the server through which pages play them."""
