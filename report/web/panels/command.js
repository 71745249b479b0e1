// SPDX-License-Identifier: BSD-3-Clause
// Shows the command that gives an order, for a page that may not give it, and copies it.
// Its box has a sentence (span), a button and the command (pre).
import { mayTakeControl } from './requests.js';
import { put } from '../text.js';

const partOf = (box, tag) => box.querySelector(tag);

export function offerCommand(box, command) {
  put(
    partOf(box, 'span'),
    mayTakeControl()
      ? 'Take control to send it. Or run this where the team’s key is:'
      : 'This page only shows. Run this where the team’s key is:',
  );
  if (partOf(box, 'pre').textContent === command) return;
  put(partOf(box, 'pre'), command);
  put(partOf(box, 'button'), 'Copy');
}

export async function copyCommand(box) {
  const button = partOf(box, 'button'),
    command = partOf(box, 'pre');
  try {
    await navigator.clipboard.writeText(command.textContent);
    put(button, 'Copied');
  } catch {
    // Without https the browser has no clipboard: the text is selected instead.
    getSelection().selectAllChildren(command);
    put(button, 'Selected: press Ctrl-C');
  }
}
