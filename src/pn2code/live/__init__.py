"""The live view: a page that is fed while a cell runs. The run hands pictures to a server in a process of its own."""
