// The frame of a page: head, menu, search, contents.
const escape = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;");

function menuOf(menu, address, base) {
  return menu
    .map(({ title, links }) => {
      const items = links.map(
        (link) =>
          `<li><a href="${base}${link.address}"${link.address === address ? ' aria-current="page"' : ""}>${escape(link.title)}</a></li>`,
      );
      return `<h2>${escape(title)}</h2><ul>${items.join("")}</ul>`;
    })
    .join("\n");
}

function contentsOf(headings) {
  const parts = headings.filter((heading) => heading.level === 2);
  if (parts.length < 2) return "";
  const items = parts.map((heading) => `<li><a href="#${heading.id}">${escape(heading.text)}</a></li>`);
  return `<aside aria-label="On this page"><h2>On this page</h2><ul>${items.join("")}</ul></aside>`;
}

export function layout({ menu, html, headings, title, address, base }) {
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escape(title)}${title === "pcednet" ? "" : " · pcednet"}</title>
<link rel="icon" href="${base}assets/pcednet.svg">
<link rel="stylesheet" href="${base}assets/style.css">
</head>
<body data-base="${base}">
<header>
<button id="menu" aria-expanded="false" aria-controls="nav">Menu</button>
<a class="home" href="${base}index.html"><img src="${base}assets/pcednet.svg" alt="" width="26" height="26"> pcednet</a>
<form role="search"><input id="search" type="search" placeholder="Search ( / )" aria-label="Search" autocomplete="off"></form>
</header>
<div id="search-results" role="region" aria-label="Search results" aria-live="polite" hidden></div>
<div class="columns">
<nav id="nav" aria-label="Pages">
${menuOf(menu, address, base)}
</nav>
<main>
${html}
</main>
${contentsOf(headings)}
</div>
<script src="${base}assets/minisearch.js" defer></script>
<script src="${base}assets/search.js" defer></script>
<script src="${base}assets/page.js" defer></script>
</body>
</html>
`;
}
