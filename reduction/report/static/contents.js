// Sections of one kind are folded.  A link, a search of the browser and the printer open them.

const folds = [...document.querySelectorAll("details.chapter")];
const KEPT = ".provenance, .notes"; // long, and not for paper
let opened = [];

const openForPaper = () => {
  opened = [...document.querySelectorAll("details:not([open])")].filter((part) => !part.matches(KEPT));
  opened.forEach((part) => { part.open = true; });
};
const foldAgain = () => {
  opened.forEach((part) => { part.open = false; });
  opened = [];
};

/** Open all that an element is folded into, and go to it. */
const goTo = (name) => {
  const target = document.getElementById(decodeURIComponent(name));
  if (!target) return;
  for (let part = target.closest("details"); part; part = part.parentElement.closest("details")) {
    part.open = true;
  }
  target.scrollIntoView();
};
document.addEventListener("click", (event) => {
  const link = event.target.closest("a[href^='#']");
  if (link) goTo(link.hash.slice(1));
});
addEventListener("hashchange", () => goTo(location.hash.slice(1)));
if (location.hash) goTo(location.hash.slice(1));

const openAll = document.getElementById("open-all");
if (openAll) {
  const areOpen = () => folds.every((part) => part.open);
  const name = () => { openAll.textContent = areOpen() ? "Close all sections" : "Open all sections"; };
  openAll.addEventListener("click", () => {
    const open = !areOpen();
    folds.forEach((part) => { part.open = open; });
    name();
  });
  folds.forEach((part) => part.addEventListener("toggle", name));
}

const filter = document.getElementById("filter");
if (filter) {
  const links = [...document.querySelectorAll("#contents li")];
  const found = document.getElementById("found");
  const words = (link) => {
    const section = document.getElementById(link.querySelector("a").hash.slice(1))?.closest("summary");
    return (section ?? link).textContent.toLowerCase();
  };
  filter.addEventListener("input", () => {
    const wanted = filter.value.trim().toLowerCase().split(/\s+/);
    for (const link of links) link.hidden = !wanted.every((word) => words(link).includes(word));
    const left = links.filter((link) => !link.hidden).length;
    found.textContent = filter.value.trim() ? `${left} of ${links.length}` : "";
  });
  filter.addEventListener("keydown", (event) => {
    if (event.key === "Enter") links.find((link) => !link.hidden)?.querySelector("a").click();
  });
}

// the list of contents marks the section that is at the top of the screen
const list = document.querySelector("nav");
const atTop = new IntersectionObserver((seen) => {
  for (const { target, isIntersecting } of seen) {
    const link = list?.querySelector(`a[href="#${target.getAttribute("aria-labelledby")}"]`);
    if (!link) continue;
    if (!isIntersecting) {
      link.removeAttribute("aria-current");
      continue;
    }
    link.setAttribute("aria-current", "true");
    if (list.scrollHeight > list.clientHeight) list.scrollTop = link.offsetTop - list.clientHeight / 2;
  }
}, { rootMargin: "-10% 0px -85%" });
document.querySelectorAll("main > section").forEach((section) => atTop.observe(section));
