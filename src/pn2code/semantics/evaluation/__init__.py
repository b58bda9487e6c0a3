"""The evaluator of the typed core language, with its files, references and random numbers."""
