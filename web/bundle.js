// What page.js finds when the libraries were there at build time.
import {charts} from './charts.js';
import {replay} from './replay.js';

globalThis.aircutPage = {charts, replay};
