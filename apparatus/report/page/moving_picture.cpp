#include "apparatus/report/page/moving_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "apparatus/report/page/page.hpp"

namespace tremie::report {
namespace {

using Json = nlohmann::ordered_json;

struct Extent {
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  void include(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
};

Extent extent_of(const MovingPicture& picture) {
  Extent e;
  for (const MovingFrame& frame : picture.frames)
    for (const auto& p : frame.places) e.include(p[0], p[1]);
  for (const auto* walls : {&picture.fixed, &picture.lifted})
    for (const Polyline& wall : *walls)
      for (const auto& p : wall) e.include(p[0], p[1]);
  if (e.x0 > e.x1) e = {0.0, 1.0, 0.0, 1.0};
  e.x1 = std::max(e.x1, e.x0 + 1e-6), e.y1 = std::max(e.y1, e.y0 + 1e-6);
  return e;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : letters[group >> (18 - 6 * k) & 63U];
  }
  return text;
}

std::uint8_t shade(double v, const ColourField& field) {
  const double share = field.log
                           ? std::log(std::max(v, field.low) / field.low) / std::log(field.high / field.low)
                           : (v - field.low) / (field.high - field.low);
  return static_cast<std::uint8_t>(std::isfinite(share) ? std::lround(255.0 * std::clamp(share, 0.0, 1.0))
                                                        : 0);
}

/// All x (16 bit, low byte first), all y, then a byte a point for each field.
std::vector<std::uint8_t> bytes_of(const MovingFrame& frame, const std::vector<ColourField>& fields,
                                   const Extent& e) {
  std::vector<std::uint8_t> bytes;
  const auto add = [&](double share) {
    const auto v = static_cast<std::uint16_t>(
        std::isfinite(share) ? std::lround(65535.0 * std::clamp(share, 0.0, 1.0)) : 0);
    bytes.push_back(static_cast<std::uint8_t>(v & 255U)), bytes.push_back(static_cast<std::uint8_t>(v >> 8));
  };
  for (const auto& p : frame.places) add((p[0] - e.x0) / (e.x1 - e.x0));
  for (const auto& p : frame.places) add((p[1] - e.y0) / (e.y1 - e.y0));
  for (std::size_t f = 0; f < fields.size(); ++f)
    for (std::size_t i = 0; i < frame.places.size(); ++i)
      bytes.push_back(shade(frame.values[f][i], fields[f]));
  return bytes;
}

/// Few digits: the page is looked at, and its size counts.
double rounded(double v, int digits) { return std::stod(fmt::format("{:.{}g}", v, digits)); }

Json walls_json(const std::vector<Polyline>& walls) {
  Json list = Json::array();
  for (const Polyline& wall : walls) {
    Json& line = list.emplace_back(Json::array());
    for (const auto& p : wall) line.push_back({rounded(p[0], 5), rounded(p[1], 5)});
  }
  return list;
}

std::string data_json(const MovingPicture& picture) {
  const Extent e = extent_of(picture);
  Json frames = Json::array(), fields = Json::array();
  for (const MovingFrame& frame : picture.frames)
    frames.push_back({{"t", rounded(frame.time, 4)},
                      {"a", rounded(frame.turned, 5)},
                      {"n", frame.places.size()},
                      {"d", base64(bytes_of(frame, picture.fields, e))}});
  for (const ColourField& field : picture.fields)
    fields.push_back(
        {{"low", fmt::format("{:.2g}", field.low)}, {"high", fmt::format("{:.2g}", field.high)}});
  return Json{{"box", {rounded(e.x0, 6), rounded(e.x1, 6), rounded(e.y0, 6), rounded(e.y1, 6)}},
              {"mirrored", picture.mirrored},
              {"full", picture.full},
              {"speed", rounded(picture.lift_speed, 5)},
              {"fixed", walls_json(picture.fixed)},
              {"lifted", walls_json(picture.lifted)},
              {"turning", walls_json(picture.turning)},
              {"fields", std::move(fields)},
              {"frames", std::move(frames)}}
      .dump();
}

void thin_points(MovingFrame& frame, std::size_t most) {
  const std::size_t n = frame.places.size(), stride = (n + most - 1) / std::max<std::size_t>(most, 1);
  if (stride < 2) return;
  const auto every = [stride](auto& list) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < list.size(); i += stride) list[k++] = list[i];
    list.resize(k);
  };
  every(frame.places);
  for (auto& values : frame.values) every(values);
}

}  // namespace

MovingPicture thinned(MovingPicture picture, std::size_t most_frames, std::size_t most_points) {
  auto& frames = picture.frames;
  if (most_frames >= 2 && frames.size() > most_frames) {
    std::vector<MovingFrame> kept;
    for (std::size_t i = 0; i < most_frames; ++i)
      kept.push_back(std::move(frames[i * (frames.size() - 1) / (most_frames - 1)]));
    frames = std::move(kept);
  }
  for (MovingFrame& frame : frames) thin_points(frame, most_points);
  return picture;
}

std::string moving_html(const MovingPicture& picture) {
  if (picture.frames.empty()) return {};
  std::string options;
  for (std::size_t i = 0; i < picture.fields.size(); ++i) {
    const ColourField& f = picture.fields[i];
    options += fmt::format("<option value=\"{}\">{}{}</option>", i, escaped(f.words),
                           f.unit.empty() ? "" : escaped(" (" + f.unit + ")"));
  }
  return fmt::format(
      "<figure id=\"moving\" class=\"screen\"><canvas id=\"moving-canvas\" role=\"img\" "
      "aria-label=\"{0}\"></canvas>\n"
      "<div class=\"controls\"><button id=\"moving-play\" type=\"button\">Play</button>"
      "<input id=\"moving-time\" type=\"range\" min=\"0\" max=\"{1}\" value=\"{1}\" aria-label=\"time\">"
      "<output id=\"moving-now\"></output>\n<label>colour <select "
      "id=\"moving-field\">{2}</select></label></div>\n"
      "<figcaption>{0}</figcaption>\n<script type=\"application/json\" "
      "id=\"moving-data\">{3}</script></figure>\n",
      escaped(picture.caption), picture.frames.size() - 1, options, data_json(picture));
}

const char* const moving_script = R"js("use strict";(()=>{
const get=id=>document.getElementById(id),m=JSON.parse(get("moving-data").textContent);
const canvas=get("moving-canvas"),slider=get("moving-time"),field=get("moving-field"),play=get("moving-play"),now=get("moving-now");
const [bx0,bx1,y0,y1]=m.box,x0=m.mirrored?-Math.max(Math.abs(bx0),Math.abs(bx1)):bx0,x1=m.mirrored?-x0:bx1;
const stops=[[0,103,165],[90,130,165],[165,150,130],[225,150,60],[250,170,20]];
const rgb=Array.from({length:256},(_,i)=>{const s=i/255*4,k=Math.min(3,Math.floor(s)),f=s-k;
return stops[k].map((c,j)=>Math.round(c+f*(stops[k+1][j]-c)));}),shades=rgb.map(c=>"rgb("+c+")");
const frames=m.frames.map(f=>{const raw=atob(f.d),b=Uint8Array.from(raw,c=>c.charCodeAt(0)),n=f.n,x=new Float32Array(n),y=new Float32Array(n);
for(let i=0;i<n;i++){x[i]=bx0+(b[2*i]+256*b[2*i+1])/65535*(bx1-bx0);y[i]=y0+(b[2*n+2*i]+256*b[2*n+2*i+1])/65535*(y1-y0);}
return {t:f.t,a:f.a,n,x,y,shade:b.subarray(4*n)};});
// Thinned points stand for all: what lies within reach of one has its colour, and the outline is drawn back by as
// much as the reach goes beyond a point's own half-width.
function fill(c,f,k,css,h,X,Y,scale){
const g=2,W=Math.ceil(css/g),H=Math.ceil(h/g),far=1e9,d2=new Float32Array(W*H).fill(far),shade=new Uint8Array(W*H),sides=m.mirrored?[1,-1]:[1];
const q=Math.max(g,Math.sqrt((bx1-bx0)*(y1-y0)/f.n)*scale*1.5),seen=new Set();
for(let i=0;i<f.n;i++)seen.add(Math.floor(X(f.x[i])/q)*8192+Math.floor(Y(f.y[i])/q));
const space=Math.sqrt(seen.size/f.n)*q,R=Math.min((m.full?40:24)*Math.min(1,css/800),Math.max(3,(m.full?5:2.5)*space))/g,back=m.full?-1:Math.max(0,R-.55*space/g);
for(let i=0;i<f.n;i++)for(const s of sides){const x=X(s*f.x[i])/g,y=Y(f.y[i])/g,col=f.shade.length?f.shade[k*f.n+i]:0;
for(let b=Math.max(0,Math.ceil(y-.5-R));b<=Math.min(H-1,y-.5+R);b++)for(let a=Math.max(0,Math.ceil(x-.5-R));a<=Math.min(W-1,x-.5+R);a++){
const d=(a+.5-x)*(a+.5-x)+(b+.5-y)*(b+.5-y),at=b*W+a;if(d<=R*R&&d<d2[at]){d2[at]=d;shade[at]=col;}}}
const off=new Float32Array(W*H);for(let i=0;i<off.length;i++)off[i]=d2[i]<far?far:0;
const near=(at,to,w)=>{if(off[to]+w<off[at])off[at]=off[to]+w;},r2=Math.SQRT2;
for(let b=1;b<H;b++)for(let a=1;a<W-1;a++){const at=b*W+a;near(at,at-1,1);near(at,at-W,1);near(at,at-W-1,r2);near(at,at-W+1,r2);}
for(let b=H-2;b>=0;b--)for(let a=W-2;a>0;a--){const at=b*W+a;near(at,at+1,1);near(at,at+W,1);near(at,at+W+1,r2);near(at,at+W-1,r2);}
const image=new ImageData(W,H),to=document.createElement("canvas");
for(let i=0;i<off.length;i++)if(off[i]>back&&d2[i]<far){const [r,gr,bl]=rgb[shade[i]];image.data.set([r,gr,bl,255],4*i);}
to.width=W;to.height=H;to.getContext("2d").putImageData(image,0,0);c.imageSmoothingEnabled=false;c.drawImage(to,0,0,W*g,H*g);}
function draw(){
const f=frames[+slider.value],css=canvas.clientWidth||600,dpr=window.devicePixelRatio||1,pad=14,bar=34;
const scale=Math.min((css-2*pad)/(x1-x0),Math.max(260,.42*css)/(y1-y0)),h=Math.ceil((y1-y0)*scale)+2*pad+bar;
canvas.width=css*dpr;canvas.height=h*dpr;canvas.style.height=h+"px";
const c=canvas.getContext("2d");c.scale(dpr,dpr);c.clearRect(0,0,css,h);
const ox=css/2-(x0+x1)/2*scale,oy=pad+y1*scale,X=v=>ox+v*scale,Y=v=>oy-v*scale,ink=getComputedStyle(document.body).color;
const k=+field.value||0;
c.save();if(m.full){c.beginPath();m.fixed[0].forEach(p=>c.lineTo(X(p[0]),Y(p[1])));c.clip();}
if(f.n)fill(c,f,k,css,h,X,Y,scale);
c.restore();
c.strokeStyle=ink;c.lineWidth=2;
const wall=(w,up,s)=>{c.beginPath();w.forEach((p,i)=>i?c.lineTo(X(s*p[0]),Y(p[1]+up)):c.moveTo(X(s*p[0]),Y(p[1]+up)));c.stroke();};
for(const s of m.mirrored?[1,-1]:[1]){for(const w of m.fixed)wall(w,0,s);for(const w of m.lifted)wall(w,m.speed*f.t,s);}
const ca=Math.cos(f.a),sa=Math.sin(f.a);c.fillStyle=ink;
for(const w of m.turning){wall(w.map(([x,y])=>[ca*x-sa*y,sa*x+ca*y]),0,1);c.fill();}
if(m.fields.length){const r=m.fields[k],w=Math.min(220,css-150),top=h-22,left=css/2-w/2;
for(let i=0;i<w;i++){c.fillStyle=shades[Math.floor(i/w*255)];c.fillRect(left+i,top,1.5,10);}
c.fillStyle=ink;c.font="13px system-ui,sans-serif";c.textAlign="right";c.fillText(r.low,left-6,top+10);
c.textAlign="left";c.fillText(r.high,left+w+6,top+10);}
now.textContent=f.t.toFixed(f.t<10?1:0)+" s";}
let timer=0;const stop=()=>{clearInterval(timer);timer=0;play.textContent="Play";};
play.onclick=()=>{if(timer)return stop();if(+slider.value>=frames.length-1)slider.value=0;play.textContent="Pause";
timer=setInterval(()=>{if(+slider.value>=frames.length-1)return stop();slider.value=+slider.value+1;draw();},160);};
slider.oninput=()=>{stop();draw();};field.onchange=draw;addEventListener("resize",draw);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change",draw);
if(m.fields.length<2)field.parentElement.hidden=true;
draw();})();
)js";

}  // namespace tremie::report
