// The scene as three.js draws it: cloths and bodies, lights, planes with a grid, the camera.
import {
  BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, HemisphereLight, LineBasicMaterial, LineSegments, Mesh,
  MeshLambertMaterial, PerspectiveCamera, Points, PointsMaterial, Scene, Sphere, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { smooth_normals, creased } from "./normals.js";
import { floor_of, grid_spacing } from "./floor.js";
import { view_box } from "./view_box.js";

const cloth_tones = ["#4f8fc9", "#c9724f", "#5aa57a", "#a678c2", "#c2a24a", "#4fa9b8"];
const white = new Color("white"), dark = new Color("#565e68");
const body_tone = "#b5aea4";
const crease = (40 / 180) * Math.PI;

// The back of a cloth is a little darker and warmer than its front.
function two_tones(material) {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <color_fragment>",
      "#include <color_fragment>\n  if (!gl_FrontFacing) diffuseColor.rgb *= vec3(0.92, 0.80, 0.68);",
    );
  };
  return material;
}

function dynamic(count, item = 3) {
  const attribute = new BufferAttribute(new Float32Array(item * count), item);
  attribute.setUsage(35048); // DYNAMIC_DRAW
  return attribute;
}

// A shape as drawn. Bodies have their vertices taken apart at sharp edges: source tells of which each is a copy.
class Drawn {
  constructor(shape, tone, sphere) {
    this.shape = shape;
    this.tone = new Color(tone);
    this.positions = new Float32Array(3 * shape.vertices);
    shape.track.copy_to(this.positions, 0);
    const parted = shape.body ? creased(this.positions, shape.triangles, crease) : null;
    this.source = parted?.source;
    const count = parted ? parted.source.length : shape.vertices, triangles = parted ? parted.triangles : shape.triangles;
    this.geometry = new BufferGeometry();
    this.position = dynamic(count);
    this.normal = dynamic(count);
    this.geometry.setAttribute("position", this.position).setAttribute("normal", this.normal);
    this.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.geometry.boundingSphere = sphere;
    if (!shape.body) this.geometry.setAttribute("color", (this.colour = dynamic(count)));
    const material = new MeshLambertMaterial({ side: DoubleSide, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });
    this.mesh = new Mesh(this.geometry, shape.body ? material : two_tones(material));
    this.mesh.frustumCulled = false;
    this.lines = this.#wireframe();
    this.frame = -1;
    this.fill = new Color(dark);
    this.set_look({ painted: false, wireframe: false });
  }

  // The edges of the faces as the file has them, over the vertices of the shape itself.
  #wireframe() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.source ? new BufferAttribute(this.positions, 3) : this.position);
    geometry.setIndex(new BufferAttribute(this.shape.edges, 1));
    const lines = new LineSegments(geometry, new LineBasicMaterial({ color: this.tone }));
    if (this.colour) geometry.setAttribute("color", this.colour);
    lines.frustumCulled = lines.visible = false;
    return lines;
  }

  // One colour for all of it, or one for every vertex; as a wireframe the lines have them, and the faces are grey.
  set_look({ painted = this.painted, wireframe = this.wireframe }) {
    if (painted === this.painted && wireframe === this.wireframe) return;
    Object.assign(this, { painted, wireframe });
    // Faces lie behind the lines on them, and only then: a steep face is put farther back than a flat one close beneath it,
    // which would show through.
    this.mesh.material.polygonOffset = wireframe;
    for (const { material } of [this.mesh, this.lines]) {
      const grey = wireframe && material === this.mesh.material;
      material.vertexColors = painted && !grey;
      material.color.copy(grey ? (painted ? dark : this.fill) : painted ? white : this.tone);
      material.needsUpdate = true;
    }
  }

  show(frame) {
    const at = Math.min(frame, this.shape.track.frames - 1);
    if (at === this.frame) return;
    this.frame = at;
    if (!this.source) this.positions = this.position.array;
    this.shape.track.copy_to(this.positions, at);
    if (this.source) {
      const { source, positions } = this, out = this.position.array;
      for (let i = 0; i < source.length; ++i) out.set(positions.subarray(3 * source[i], 3 * source[i] + 3), 3 * i);
      this.lines.geometry.attributes.position.needsUpdate = true;
    }
    smooth_normals(this.normal.array, this.position.array, this.geometry.index.array);
    this.position.needsUpdate = this.normal.needsUpdate = true;
  }

  paint(colouring, frame) {
    if (!this.colour) return;
    const painted = colouring.paint(this.colour.array, this.shape, frame);
    this.set_look({ painted });
    this.colour.needsUpdate = painted;
  }
}

// Light from behind the viewer, and from everywhere: whatever side one looks at can be seen.
function light(scene, camera) {
  const sun = new DirectionalLight("white", 2.0);
  sun.position.set(-0.5, 0.9, 0.6);
  camera.add(sun);
  camera.add(sun.target);
  sun.target.position.set(0, 0, -1);
  scene.add(new HemisphereLight("#ffffff", "#8d8478", 1.7), camera);
}

export class Stage {
  constructor(canvas, shapes, planes, colouring) {
    this.canvas = canvas;
    this.colouring = colouring;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(35, 1, 0.01, 100);
    light(this.scene, this.camera);
    this.box = view_box(shapes, planes);
    const sphere = new Sphere(new Vector3(...this.box.middle), 1e6 * this.box.radius); // drawn and picked wherever it is
    let cloths = 0;
    this.drawn = shapes.map((shape) => new Drawn(shape, shape.body ? body_tone : cloth_tones[cloths++ % cloth_tones.length], sphere));
    for (const drawn of this.drawn) this.scene.add(drawn.mesh, drawn.lines);
    this.grid_spacing = Number(grid_spacing(this.box.radius).toPrecision(1));
    this.floors = planes.map((plane) => floor_of(plane, this.box));
    for (const floor of this.floors) this.scene.add(floor.mesh);
    this.marker = this.#make_marker();
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.15;
    this.controls.addEventListener("change", () => (this.dirty = true));
    this.update_ms = 0;
    this.scale = 1;
    this.dirty = true;
    this.reset_view();
  }

  #make_marker() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3), 3));
    const material = new PointsMaterial({ size: 12, sizeAttenuation: false, depthTest: false, transparent: true, color: "#ff2d6f" });
    material.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace(
        "#include <color_fragment>",
        "#include <color_fragment>\n  float away = distance(gl_PointCoord, vec2(0.5));\n  if (away > 0.5) discard;\n" +
          "  if (away > 0.33) diffuseColor.rgb = vec3(1.0);",
      );
    };
    const marker = new Points(geometry, material);
    marker.frustumCulled = marker.visible = false;
    marker.renderOrder = 10;
    this.scene.add(marker);
    return marker;
  }

  reset_view() {
    const { middle, radius, up } = this.box, { camera } = this;
    const towards = new Vector3(...(up[1] > 0.5 ? [0.5, 0.42, 1] : [0.5, -1, 0.42])).normalize();
    camera.up.set(...up);
    camera.position.copy(towards).multiplyScalar(this.#distance(towards)).add(new Vector3(...middle));
    camera.near = radius / 100;
    camera.far = radius * 200;
    camera.updateProjectionMatrix();
    this.controls.target.set(...middle);
    this.controls.update();
    this.dirty = true;
  }

  // From which all corners of the box are seen, with a rim.
  #distance(towards) {
    const { low, high, middle, up } = this.box, room = 0.94 * Math.tan((this.camera.fov * Math.PI) / 360);
    const across = new Vector3(...up).cross(towards).normalize(), upward = towards.clone().cross(across);
    let distance = 0;
    for (let k = 0; k < 8; ++k) {
      const corner = new Vector3(...low.map((x, c) => ((k >> c) & 1 ? high[c] : x) - middle[c]));
      const wide = Math.abs(corner.dot(across)) / this.camera.aspect, tall = Math.abs(corner.dot(upward));
      distance = Math.max(distance, corner.dot(towards) + Math.max(wide, tall) / room);
    }
    return distance || 1;
  }

  // Round the target, by keys.
  turn(azimuth, polar) {
    this.controls.rotateLeft(azimuth);
    this.controls.rotateUp(polar);
    this.dirty = true;
  }

  show(frame) {
    const start = performance.now();
    for (const drawn of this.drawn) {
      drawn.show(frame);
      drawn.paint(this.colouring, frame);
    }
    for (const floor of this.floors) floor.show(frame);
    this.frame = frame;
    this.update_ms = performance.now() - start;
    this.dirty = true;
  }

  mark(position) {
    this.marker.visible = position !== null;
    if (position) this.marker.geometry.attributes.position.array.set(position);
    this.marker.geometry.attributes.position.needsUpdate = true;
    this.dirty = true;
  }

  set_visible({ wireframe, bodies }) {
    for (const drawn of this.drawn) {
      const { mesh, lines, shape } = drawn;
      mesh.visible = bodies || !shape.body;
      lines.visible = wireframe && (bodies || !shape.body);
      drawn.set_look({ wireframe });
    }
    for (const floor of this.floors) floor.mesh.visible = bodies;
    this.dirty = true;
  }

  set_theme({ background, floor, grid }) {
    this.scene.background = new Color(background);
    for (const each of this.floors) each.set_colours(floor, grid);
    for (const { fill, mesh, wireframe, painted } of this.drawn) {
      fill.set(floor);
      if (wireframe && !painted) mesh.material.color.copy(fill);
    }
    this.dirty = true;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(this.scale * Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.dirty = true;
  }

  // So many pixels a side, of those that the window has.
  set_scale(scale) {
    if (scale === this.scale) return;
    this.scale = scale;
    this.resize();
  }

  draw() {
    this.controls.update();
    if (!this.dirty) return;
    this.dirty = false;
    this.renderer.render(this.scene, this.camera);
  }
}
