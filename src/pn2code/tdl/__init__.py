"""The robot script language: grammar, static checks, interpreter."""
