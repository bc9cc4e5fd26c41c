// The page's search and filter, and rows that open when a link asks for them. Without it the page is whole; its
// controls are then not shown. What is chosen stands in the address as "#?text=...": no anchor begins with "?".
"use strict";
(() => {
  const ENTRIES = ".claim-row, .finding, .fault, .case, .study, .rates tbody tr";
  const form = document.querySelector("form.filter");
  if (!form) return;
  const fields = ["text", "section", "verdict", "subject"].map(name => form.elements[name]);
  const [text, section, verdict, subject] = fields;
  const shown = form.querySelector("output");
  const main = document.querySelector("main");
  const sections = [...document.querySelectorAll("main > section")];
  const containers = document.querySelectorAll("main section, .group");
  const groups = [...document.querySelectorAll("details.group")];
  const entries = [...document.querySelectorAll(ENTRIES)].map(entryOf);
  let openBefore = null;   // which groups were open before a filter opened others

  // ---- what can be found ----

  function wordsOf(element, selector) {
    return [...element.querySelectorAll(selector)].map(part => part.textContent.trim());
  }

  function entryOf(element) {
    const own = element.matches(".case, .study") ? ":scope > h3, :scope > .lead, :scope > .about" : "summary";
    const parts = wordsOf(element, element.matches("details, .case, .study") ? own : ":scope > *");
    const verdictOf = element.matches(".study") ? "" : wordsOf(element, ".ruling, .verdict")[0] ?? "";
    return { element, verdict: verdictOf, subjects: subjectsOf(element), words: parts.join(" ").toLowerCase(),
             section: element.closest("main > section")?.id };
  }

  function subjectsOf(element) {
    if (element.matches(".claim-row")) {
      const paper = element.closest("[data-subject]")?.dataset.subject;
      return new Set([paper, ...wordsOf(element, ".deciding code").map(prefixOf)].filter(Boolean));
    }
    if (element.matches(".fault")) return new Set(wordsOf(element, ".by a").map(prefixOf));
    if (element.matches(".study")) return new Set([prefixOf(element.id.replace(/^study-/, ""))]);
    return new Set(element.matches(".case") ? ["case"] : [prefixOf(element.id)]);
  }

  function prefixOf(name) { return name.split(".")[0]; }

  // ---- the controls ----

  function fillControls() {
    const used = new Set(entries.map(entry => entry.section));
    addOptions(section, sections.filter(part => used.has(part.id)).map(part => [part.id, wordsOf(part, "h2")[0]]));
    addOptions(verdict, [...new Set(entries.map(entry => entry.verdict).filter(Boolean))].map(word => [word, word]));
    const subjects = [...new Set(entries.flatMap(entry => [...entry.subjects]))];
    const paper = new Set([...document.querySelectorAll("[data-subject]")].map(part => part.dataset.subject));
    addOptions(addGroup(subject, "Of the paper"), subjects.filter(word => paper.has(word)).map(word => [word, word]));
    addOptions(addGroup(subject, "First part of a finding's name"),
               subjects.filter(word => !paper.has(word)).sort().map(word => [word, word]));
  }

  function addGroup(list, label) {
    const group = document.createElement("optgroup");
    group.label = label;
    return list.appendChild(group);
  }

  function addOptions(list, pairs) {
    for (const [value, label] of pairs) list.append(new Option(label, value));
    if (list.tagName === "OPTGROUP" && !pairs.length) list.remove();
  }

  // ---- showing ----

  // a reader may type the name of a Greek letter that the page shows
  const GREEK = {{ greek }};

  function hasWord(entry, word) {
    const letters = word.replace(/[a-z]+/g, name => GREEK[name] ?? name);
    return entry.words.includes(word) || entry.words.includes(letters);
  }

  function isActive() { return fields.some(field => field.value.trim()); }

  function matches(entry, wanted) {
    return (!section.value || entry.section === section.value) && (!verdict.value || entry.verdict === verdict.value)
      && (!subject.value || entry.subjects.has(subject.value)) && wanted.every(word => hasWord(entry, word));
  }

  function show() {
    const active = isActive(), kept = new Set();
    const wanted = text.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const entry of entries) {
      entry.matches = matches(entry, wanted);
      count += entry.matches;
      for (let part = entry.matches ? entry.element : null; part; part = part.parentElement) kept.add(part);
    }
    for (const entry of entries) entry.element.hidden = !kept.has(entry.element);
    for (const part of containers) part.hidden = active && !kept.has(part);
    openGroups(active);
    document.documentElement.classList.toggle("filtered", active);
    shown.textContent = active ? `${count} of ${entries.length} match` : `${entries.length} ${entries.length === 1 ? "entry" : "entries"}`;
  }

  function openGroups(active) {
    if (active) {
      openBefore ??= groups.map(group => group.open);
      for (const group of groups) group.open = true;
    } else if (openBefore) {
      groups.forEach((group, k) => { group.open = openBefore[k]; });
      openBefore = null;
    }
  }

  // ---- the address ----

  function writeAddress() {
    const chosen = new URLSearchParams(fields.filter(field => field.value.trim()).map(field => [field.name, field.value]));
    const before = location.href.split("#")[0];
    if (isActive()) history.replaceState(null, "", `${before}#?${chosen}`);
    else if (location.hash.startsWith("#?")) history.replaceState(null, "", before);
  }

  function readAddress() {
    if (location.hash.startsWith("#?")) {
      const chosen = new URLSearchParams(location.hash.slice(2));
      for (const field of fields) field.value = chosen.get(field.name) ?? "";
      show();
      main.scrollIntoView();
    } else if (location.hash.length > 1) {
      reveal(document.getElementById(decodeURIComponent(location.hash.slice(1))));
    }
  }

  function reveal(target) {
    if (!target) return;
    if (target.closest("[hidden]")) {
      form.reset();
      show();
    }
    for (let part = target; part; part = part.parentElement) if (part.tagName === "DETAILS") part.open = true;
    target.scrollIntoView();
  }

  // ---- what a reader does ----

  let waiting = 0;
  form.addEventListener("input", () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => { show(); writeAddress(); main.scrollIntoView(); }, 100);
  });
  form.addEventListener("reset", () => setTimeout(() => { show(); writeAddress(); }));
  form.addEventListener("submit", event => {
    event.preventDefault();
    entries.find(entry => entry.matches)?.element.scrollIntoView();
  });
  document.addEventListener("keydown", event => {
    const writing = event.target.closest?.("input, select, textarea, [contenteditable]");
    if (event.key === "/" && !writing && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      text.focus();
    }
  });
  document.addEventListener("click", event => {
    const link = event.target.closest?.('a[href^="#"]');
    if (link && link.hash === location.hash) readAddress();   // no hashchange follows
  });
  addEventListener("hashchange", readAddress);

  fillControls();
  form.hidden = false;
  document.documentElement.classList.add("with-filter");
  show();
  readAddress();
})();
