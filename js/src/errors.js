// Errors of decoders.

/** Codes and messages by status of the C decoders (enum lacedring_status). */
const STATUSES = [
  ["OK", ""],
  ["SHORT", "fewer words than a header has"],
  ["MAGIC", "another kind of data"],
  ["VERSION", "a version that is not read"],
  ["VERTICES", "an impossible number of vertices"],
  ["RING_VERTICES", "more ring vertices than vertices"],
  ["SIZE", "not as many words as the header says"],
  ["SLOTS", "more triangles than 32-bit indices can number"],
  ["CHECKSUM", "the checksum does not match"],
  ["TIP", "a tip that is no vertex"],
  ["OPEN_RING", "a ring that does not close"],
  ["SHORT_RING", "a ring of fewer than three vertices"],
  ["CLOSING_WORD", "an impossible closing word"],
  ["WORD", "an impossible word"],
  ["VERBATIM", "an impossible verbatim triangle"],
  ["TRIANGLES", "another number of triangles than the header says"],
  ["GROUP", "an impossible group of blocks"],
  ["BLOCK", "an impossible block"],
  ["TURNS", "more turns than triangles"],
  ["DOUBLES", "an impossible run of doubles"],
  ["HEADER", "an impossible header"],
  ["VERTEX_BLOCK", "an impossible block of vertices"],
  ["TRIANGLE", "an impossible triangle"],
  ["LIMIT", "more vertices, triangles or copies than the file says"],
  ["CODED", "a coded part that does not end where its symbols do"],
  ["INTEGER", "an integer out of range"],
  ["POSITIONS", "positions that predict are missing"],
  ["COPY", "an impossible copy of a vertex"],
];

/** The error that decoders throw: `code` is the kind of fault, `message` one line of text. */
export class LacedRingError extends Error {
  constructor(code, message) {
    super(message);
    this.name = "LacedRingError";
    this.code = code;
  }
}

/**
 * Makes an error of a C function's status. `what`: part of the file; `where`: the position or number that the function
 * reported.
 */
export function errorOf(status, what, where) {
  const [code, text] = STATUSES[status] ?? ["UNKNOWN", `status ${status}`];
  return new LacedRingError(code, `lr file: ${what}: ${text} (at ${where})`);
}
