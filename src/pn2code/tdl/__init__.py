"""The robot script language: grammar, syntax tree, checks, interpreter (docs/tdl.md).

text --parse--> tree.Program --check--> CheckedProgram --Interpreter--> requests of a driver
"""
