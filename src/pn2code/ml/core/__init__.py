"""The typed core language: terms, types, colour sets, constants, and its dump."""
