#!/usr/bin/env python3
"""Runs a program with its words, or says that it is not there and ends with 77:  python3 if_there.py PROGRAM WORD..."""
import os
import shutil
import sys

if not shutil.which(sys.argv[1]):
    print(f"skipped: there is no {sys.argv[1]} here; ./build.sh test installs it on Debian")
    sys.exit(77)
sys.stdout.flush()
os.execvp(sys.argv[1], sys.argv[1:])
