// Of every file of tests in a browser.
import { afterAll } from 'vitest';
import { leave } from './opened';

afterAll(leave);
