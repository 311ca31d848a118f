// A plane as a disc under the scene, with a grid that tells sizes; both fade out.
import { Color, DoubleSide, Mesh, PlaneGeometry, Quaternion, ShaderMaterial, Vector3 } from "three";

const vertex = `
  varying vec2 place;
  void main() {
    place = position.xy;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

// Lines about one pixel wide wherever one looks from.
const fragment = `
  varying vec2 place;
  uniform float radius, spacing;
  uniform vec3 floor_colour, grid_colour;
  void main() {
    vec2 away = abs(fract(place / spacing - 0.5) - 0.5) / fwidth(place / spacing);
    float line = 0.8 * (1.0 - min(min(away.x, away.y), 1.0));
    float inside = max(0.0, 1.0 - dot(place, place) / (radius * radius));
    gl_FragColor = vec4(mix(floor_colour, grid_colour, line), pow(inside, 1.5));
    #include <colorspace_fragment>
  }`;

// A tenth to a quarter of the scene, of 1, 2 or 5.
export function grid_spacing(radius) {
  const unit = 10 ** Math.floor(Math.log10(radius / 2));
  return unit * [5, 2, 1].find((x) => x * unit <= radius / 2);
}

export function floor_of(plane, box) {
  const radius = 3 * box.radius;
  const material = new ShaderMaterial({
    vertexShader: vertex, fragmentShader: fragment, side: DoubleSide, transparent: true, depthWrite: false,
    polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 4, // a cloth that lies on it stays in front
    uniforms: {
      radius: { value: radius }, spacing: { value: grid_spacing(box.radius) },
      floor_colour: { value: new Color() }, grid_colour: { value: new Color() },
    },
  });
  const mesh = new Mesh(new PlaneGeometry(2 * radius, 2 * radius), material);
  const middle = new Vector3(...box.middle), point = new Vector3(), normal = new Vector3(), turn = new Quaternion();
  const show = (frame) => {
    const k = Math.min(frame, plane.points.length - 1);
    point.set(...plane.points[k]);
    normal.set(...plane.normals[k]);
    mesh.position.copy(middle).addScaledVector(normal, normal.dot(point) - normal.dot(middle));
    mesh.quaternion.copy(turn.setFromUnitVectors(new Vector3(0, 0, 1), normal));
  };
  const set_colours = (floor, grid) => {
    material.uniforms.floor_colour.value.set(floor);
    material.uniforms.grid_colour.value.set(grid);
  };
  show(0);
  return { mesh, show, set_colours };
}
