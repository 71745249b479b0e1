# SPDX-License-Identifier: BSD-3-Clause
"""Laws of papers, each in a file that names paper and equations. FILE.py:CLASS names one."""
