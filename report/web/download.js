// SPDX-License-Identifier: BSD-3-Clause
// Hands a file to the person at the browser.
import { element } from './text.js';

export function download(blob, name) {
  const link = element('a');
  link.href = URL.createObjectURL(blob);
  link.download = name.replace(/[^\w.-]+/g, '_');
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
