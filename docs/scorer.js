/* Order of search results: pages whose title was typed, examples, then pages, then the interface. */
var Scorer = {
  score: ([docname, , , , score, , kind]) =>
    score +
    (kind === "title" ? 20 : 0) +
    (docname.startsWith("gallery/") ? 4 : 0) -
    (/^api\/|\/versions\//.test(docname) ? 10 : 0),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
