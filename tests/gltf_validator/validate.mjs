// SPDX-License-Identifier: MIT
// Usage: node validate.mjs file.glb ...
// Fails unless every file passes the Khronos validator without errors and warnings.
import { readFileSync } from 'node:fs';
import { dirname, resolve } from 'node:path';
import { validateBytes } from 'gltf-validator';

const files = process.argv.slice(2);
let failed = files.length === 0;
for (const file of files) {
    const { issues } = await validateBytes(new Uint8Array(readFileSync(file)), {
        uri: file,
        externalResourceFunction: (uri) =>
            Promise.resolve(new Uint8Array(readFileSync(resolve(dirname(file), decodeURIComponent(uri))))),
    });
    const { numErrors, numWarnings, numInfos, numHints } = issues;
    console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints`);
    for (const { severity, code, message, pointer } of issues.messages.slice(0, 20)) {
        if (severity <= 1) {
            console.log(`  ${severity === 0 ? 'error' : 'warning'} ${code} at ${pointer}: ${message}`);
        }
    }
    failed ||= numErrors + numWarnings > 0;
}
console.log(failed ? 'expected files, all without errors and warnings' : `${files.length} files are valid`);
process.exitCode = failed ? 1 : 0;
