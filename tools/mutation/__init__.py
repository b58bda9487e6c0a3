"""Mutants of the generated programs and of the scheduler: does `pn2code conform` find them out?"""
