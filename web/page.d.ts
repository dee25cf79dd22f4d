// What `tsc` takes for granted: the engine's glue, the kind of an element that is found, and numbers as attributes.
declare const wasm_bindgen: any;
interface Document { getElementById(id: string): any }
interface ParentNode { querySelector(selectors: string): any; querySelectorAll(selectors: string): NodeListOf<any> }
interface Node { cloneNode(deep?: boolean): any }
interface Event { target: any; currentTarget: any }
interface EventTarget { closest(selectors: string): any }
interface Element { setAttribute(name: string, value: unknown): void }
