"""Syntax tree to typed core: scopes, inference, declarations, inscriptions."""
