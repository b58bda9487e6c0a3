"""Codes of what can be wrong when programs are compared with the model."""

from pn2code.diagnostics.codes import register

PROBE_FAILED = register(
    "conform-probe",
    "the program under test cannot be run",
    "The supervisor is compiled together with files in memory and run state by state. It ended without an answer, or "
    "could not save its state (too many processes, too little memory).",
)
GENERATED_UNREADABLE = register(
    "conform-files",
    "the generated files cannot be read",
    "`--generated DIR` names a folder with the files of `pn2code generate`: programs, runtime, Makefile, manifest. "
    "One of them is missing, or a program is not a text file.",
)
