# SPDX-License-Identifier: BSD-3-Clause
"""The notebook runs to its end and draws figures. notebook_test.py NOTEBOOK"""

import sys
import unittest
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from traitlets.config import Config

NOTEBOOK = Path(sys.argv.pop())


class Notebook(unittest.TestCase):
    def test_runs(self):
        notebook = nbformat.read(NOTEBOOK, as_version=4)
        nbformat.validate(notebook)
        cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
        self.assertFalse(any(cell.outputs for cell in cells), "commit it without outputs")
        # Uses sockets in files, because another test may take a TCP port between its choice and its
        # use.
        files = Config({"KernelManager": {"transport": "ipc"}})
        NotebookClient(notebook, timeout=None, kernel_name="python3", config=files).execute()
        pictures = [
            output
            for cell in cells
            for output in cell.outputs
            if "image/png" in output.get("data", {})
        ]
        self.assertEqual(len(pictures), 3)


if __name__ == "__main__":
    unittest.main()
