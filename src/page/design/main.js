// The page of `design sweep` and `design explain`: charts, text, tables.

/** Paragraphs below headings, which stand at the left margin. */
function textSections(text) {
  let paragraphs = null;
  text.split("\n").forEach((line) => {
    if (line !== "" && !line.startsWith(" ")) {
      const words = line.replace(/:$/, "").replace(/\b[A-Z]{2,}\b/g, (word) => word.toLowerCase());
      const id = "text" + sections.length;
      paragraphs = section(id, words[0].toUpperCase() + words.slice(1)).appendChild(element("pre", {className: "text"}));
    } else if (paragraphs) {
      paragraphs.textContent += (paragraphs.textContent ? "\n" : "") + line;
    }
  });
  for (const pre of document.querySelectorAll("pre.text")) pre.textContent = pre.textContent.trimEnd();
}

function tableSections() {
  data.tables.forEach(({title, note, heads, texts, rows}, i) => {
    section("table" + i, title, note).append(tableOf(heads, texts,
      rows.map((row) => row.map((text, k) => cell(text, texts.includes(k) ? "text wide" : "")))));
  });
}

beginPage(data.title, data.subtitle);
chartSections();
textSections(data.text);
tableSections();
makeToolbar();
