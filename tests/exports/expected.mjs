// What short_run.py says the exports must hold, and how it is compared.
import { readFileSync } from "node:fs";
import { join } from "node:path";

export function read_expected(folder) {
  return JSON.parse(readFileSync(join(folder, "expected.json"), "utf8"));
}

let compared = 0;

// Numbers in float32; `tolerance` is absolute.
export function same(found, expected, tolerance, what) {
  if (found.length !== expected.length) throw new Error(`${what}: ${found.length} numbers, expected ${expected.length}`);
  for (let i = 0; i < found.length; ++i) {
    if (!(Math.abs(found[i] - expected[i]) <= tolerance)) {
      throw new Error(`${what}: number ${i} is ${found[i]}, expected ${expected[i]}`);
    }
  }
  compared += found.length;
}

export function equal(found, expected, what) {
  const [a, b] = [JSON.stringify(found), JSON.stringify(expected)];
  if (a !== b) throw new Error(`${what}: ${a.slice(0, 200)}, expected ${b.slice(0, 200)}`);
}

export function compared_count() {
  return compared;
}

// Imports a package, or ends the check as skipped.
export async function need(name) {
  try {
    return await import(name);
  } catch (error) {
    if (error.code !== "ERR_MODULE_NOT_FOUND") throw error;
    console.log(`skipped: ${name} is not there; npm ci in tests/exports installs it`);
    process.exit(77);
  }
}
