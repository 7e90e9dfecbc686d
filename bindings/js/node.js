// The entry of the package in Node.
import {readFile} from 'node:fs/promises';
import {node} from './files.js';

node.readFile = readFile;
export * from './mien.js';
