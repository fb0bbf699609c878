// What both pages do with elements. Every text goes through textContent, so that no name from a file is read as markup.
export const byId = (id) => document.getElementById(id);

export function element(tag, text, className) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

// Fills a box with buttons of which one is chosen; box.update(value) marks it. Arrow keys move from button to button.
export function radios(box, choices, choose) {
  box.replaceChildren();
  for (const [value, text] of choices) {
    const button = element("button", text);
    button.setAttribute("role", "radio");
    button.value = value;
    button.addEventListener("click", () => choose(value));
    box.append(button);
  }
  box.update = (chosen) => {
    for (const button of box.children) button.setAttribute("aria-checked", String(button.value === chosen));
  };
}

export function setDark(dark) {
  document.documentElement.classList.toggle("dark", dark);
}
export const isDark = () => document.documentElement.classList.contains("dark");
export const prefersDark = () => window.matchMedia("(prefers-color-scheme: dark)").matches;
