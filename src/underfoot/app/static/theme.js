// Light or dark as chosen, before anything is drawn.
const chosenTheme = (document.cookie.match(/(?:^|; )theme=(light|dark)/) || [])[1];
if (chosenTheme) document.documentElement.dataset.theme = chosenTheme;

function switchTheme() {
  const root = document.documentElement, media = matchMedia("(prefers-color-scheme: dark)").matches;
  const dark = !(root.dataset.theme ? root.dataset.theme === "dark" : media);
  root.dataset.theme = dark ? "dark" : "light";
  document.cookie = `theme=${root.dataset.theme}; path=/; max-age=31536000; SameSite=Strict`;
  return dark;
}
