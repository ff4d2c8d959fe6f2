// The types of what is in `three.js`, which is not read for them.
export * from './bundle/three.js'
