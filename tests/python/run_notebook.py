"""Runs a notebook from its first cell to its last: run_notebook.py FILE. Nothing of it is kept."""

import sys

import nbformat
from nbclient import NotebookClient

notebook = nbformat.read(sys.argv[1], as_version=4)
for cell in notebook.cells:
    cell.setdefault("outputs", []) if cell.cell_type == "code" else None
NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
