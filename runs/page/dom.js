// Elements of the page.

/**
 * An element with these properties and children.
 * @param {string} tag
 * @param {Record<string, unknown>} [properties]
 * @param {...(Node | string)} children
 * @returns {HTMLElement}
 */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in made) Object.assign(made, { [name]: value });
    else made.setAttribute(name, String(value));
  }
  made.append(...children);
  return made;
}

/**
 * @typedef {HTMLElement & Pick<HTMLInputElement, "value" | "disabled" | "checked">} Control
 */

/**
 * The element with this id, which must exist in the page.
 * @param {string} id
 * @returns {Control}
 */
export function byId(id) {
  return /** @type {Control} */ (document.getElementById(id));
}

/** @param {string} id */
export function dialog(id) {
  return /** @type {HTMLDialogElement} */ (document.getElementById(id));
}

/**
 * Writes a text only if it differs: reading it costs the browser nothing.
 * @param {HTMLElement} of
 * @param {string} text
 */
export function write(of, text) {
  if (of.textContent !== text) of.textContent = text;
}

/**
 * Seconds in readable form.
 * @param {number} seconds
 */
export function seconds(seconds) {
  return seconds.toFixed(3);
}
