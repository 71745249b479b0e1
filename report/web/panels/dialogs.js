// SPDX-License-Identifier: BSD-3-Clause
// Opens dialogs and menus below the panel of control, so that nothing ever covers Stop now.
import { $ } from '../text.js';

// Where the panel of control ends on the screen.
function below() {
  return $('control').hidden ? 0 : Math.max(0, $('control').getBoundingClientRect().bottom);
}

function place() {
  document.documentElement.style.setProperty('--below', `${Math.ceil(below())}px`);
}

export const openDialogOf = () => document.querySelector('dialog[open]');

// The dialog is not modal: a modal one would take Stop now away.
export function openDialog(dialog) {
  place();
  dialog.show();
  dialog.focus();
  dialog.scrollTop = 0;
}

// Opens a menu under its button, or under the panel of control.
export function placeMenu(menu, button) {
  const box = button.getBoundingClientRect();
  menu.style.top = `${Math.ceil(Math.max(box.bottom, below()) + 4)}px`;
  menu.style.right = `${Math.max(4, document.documentElement.clientWidth - box.right)}px`;
}

export function connectDialogs() {
  new ResizeObserver(place).observe($('control'));
  addEventListener('scroll', place, { passive: true });
  addEventListener('resize', place);
}
