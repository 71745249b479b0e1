# SPDX-License-Identifier: BSD-3-Clause
"""The open bench: laws of papers, and yours, beside those of Ergocast on one table.

`ergocast bench` runs it. docs/results/bench.md has its results, and describes its files.
"""
