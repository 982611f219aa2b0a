// Menu on narrow screens, and the search. Plain scripts, so that both work from disk.
(() => {
  const base = document.body.dataset.base;
  const menu = document.getElementById("menu"),
    nav = document.getElementById("nav");
  menu.addEventListener("click", () => menu.setAttribute("aria-expanded", String(nav.classList.toggle("open"))));

  const input = document.getElementById("search"),
    results = document.getElementById("search-results");
  const unasked = new Set("a an and at be by for from how i in is it my of on or the to what with".split(" "));
  let index;
  const indexed = () => {
    if (index) return index;
    index = new MiniSearch({
      fields: ["title", "page", "text"],
      storeFields: ["title", "page", "url", "text"],
      idField: "url",
      // Options are words, too: --s-max is found as it is and by its parts.
      tokenize: (text) =>
        text.split(/[\s.,;:()[\]{}"'`|=<>/]+/).flatMap((word) => {
          const parts = word.split(/[-_]+/).filter(Boolean);
          return parts.length > 1 ? [word.replace(/^-+/, ""), ...parts] : parts;
        }),
      processTerm: (term) => (unasked.has(term.toLowerCase()) ? null : term.toLowerCase()),
      searchOptions: {
        boost: { title: 4, page: 2 },
        prefix: true,
        fuzzy: (term) => (term.length > 4 ? 0.2 : false),
        combineWith: "AND",
      },
    });
    const seen = new Set();
    index.addAll(window.pcednetPages.filter((part) => !seen.has(part.url) && seen.add(part.url)));
    return index;
  };
  const excerpt = (text, terms) => {
    const places = terms.map((term) => text.toLowerCase().indexOf(term)).filter((place) => place >= 0);
    const begin = Math.max(0, Math.min(...(places.length ? places : [0])) - 60);
    return (begin > 0 ? "… " : "") + text.slice(begin, begin + 180) + (begin + 180 < text.length ? " …" : "");
  };
  const marked = (text, terms) => {
    const line = document.createElement("p");
    const pattern = new RegExp(
      `(${terms
        .map((term) => term.replace(/[^\p{L}\p{N}_-]/gu, ""))
        .filter(Boolean)
        .join("|")})`,
      "giu",
    );
    text.split(pattern).forEach((part, i) => {
      const piece = document.createElement(i % 2 ? "mark" : "span");
      piece.textContent = part;
      line.append(piece);
    });
    return line;
  };
  const show = () => {
    const query = input.value.trim();
    results.hidden = query.length < 2;
    if (results.hidden) return;
    const found = indexed().search(query).slice(0, 20);
    results.replaceChildren();
    if (!found.length) results.textContent = `Nothing about “${query}”.`;
    for (const hit of found) {
      const link = document.createElement("a");
      link.href = base + hit.url;
      const head = document.createElement("strong");
      head.textContent = hit.title === hit.page ? hit.title : `${hit.page} › ${hit.title}`;
      link.append(head, marked(excerpt(hit.text, hit.terms), hit.terms));
      link.addEventListener("click", () => (results.hidden = true));
      results.append(link);
    }
  };
  input.addEventListener("input", show);
  input.addEventListener("focus", show);
  input.form.addEventListener("submit", (event) => {
    event.preventDefault();
    results.querySelector("a")?.click();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") results.hidden = true;
    if (event.key === "/" && document.activeElement !== input) {
      event.preventDefault();
      input.focus();
    }
    const links = [...results.querySelectorAll("a")],
      at = links.indexOf(document.activeElement);
    if (results.hidden || !links.length || (at < 0 && document.activeElement !== input)) return;
    if (event.key === "ArrowDown") links[Math.min(at + 1, links.length - 1)].focus();
    else if (event.key === "ArrowUp") (at > 0 ? links[at - 1] : input).focus();
    else return;
    event.preventDefault();
  });
  document.addEventListener("click", (event) => {
    if (!results.contains(event.target) && event.target !== input) results.hidden = true;
  });
  nav.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest" });
})();
