#include "collision/hosted_detector.h"

#include "core/backend/stages.h"

namespace toile {

HostedDetector::Mesh::Mesh(const CudaSpace& space, const MeshCollider& mesh)
    : there(space, mesh.surface().triangles(), mesh.surface().positions()), x_t0(space, "collider/x_t0"),
      x_t1(space, "collider/x_t1")
{
}

HostedDetector::HostedDetector(const CudaSpace& space, View<const Triangle> triangles,
                               View<const Vec3> positions, const std::vector<ContactPartner>& partners)
    : partners_(partners), detector_(space, triangles, positions), sides_(space, positions.size()),
      x_(space, "detector/x"), reach_(space, "detector/reach")
{
    for (const ContactPartner& partner : partners)
        meshes_.push_back(partner.mesh ? std::make_unique<Mesh>(space, *partner.mesh) : nullptr);
}

/// Uploads a mesh where it has moved, or stopped, since.
void HostedDetector::follow(const MeshCollider& mesh, Mesh& there)
{
    const Mesh::Step now{mesh.move_count(), mesh.is_moving()};
    if (there.placed_at == now)
        return;
    there.x_t0.upload(mesh.pose().x_t0);
    there.x_t1.upload(mesh.surface().positions());
    there.there.move(there.x_t0.view(), there.x_t1.view());
    there.placed_at = now;
}

void HostedDetector::detect(View<const Vec3> x, View<const double> reach, const DetectSettings& settings,
                            const Learn& learn, std::vector<ContactPair>& out)
{
    const StageScope stage("collision/detect_there");
    x_.upload(x);
    reach_.upload(reach);
    detector_.move(x_.view(), reach_.view(), settings);
    for (int c = 0; c < int(partners_.size()); ++c) {
        if (meshes_[c]) {
            follow(*partners_[c].mesh, *meshes_[c]);
            detector_.detect(meshes_[c]->there, c, &sides_);
            in_front_.resize(x.size());
            detector_.in_front().download(in_front_);
            learn(c, in_front_);
        } else {
            detector_.detect(*partners_[c].shape, c);
        }
    }
    const size_t before = out.size();
    out.resize(before + detector_.pairs().size());
    detector_.download({out.data() + before, int(out.size() - before)});
}

void HostedDetector::learn_sides(View<const Vec3> x)
{
    x_.upload(x);
    for (int c = 0; c < int(partners_.size()); ++c)
        if (meshes_[c] && partners_[c].mesh->move_count() > 0) {
            follow(*partners_[c].mesh, *meshes_[c]);
            detector_.learn_sides(x_.view(), meshes_[c]->there, c, sides_);
        }
}

} // namespace toile
