"""The Python side of the shared-file protocol (docs/protocol.md)."""
