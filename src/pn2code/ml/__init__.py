"""CPN ML: grammar, syntax tree, types, and the typed core language. Knows nothing of XML or nets."""
