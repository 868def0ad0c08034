#include "collision/device_contact_energy.h"

#include "collision/device_contact_kernels.h"
#include "core/backend/cuda/parallel.cuh"

namespace toile {

DeviceContactEnergy::DeviceContactEnergy(const CudaSpace& space)
    : space_(space), terms_(space, "contact/terms"), vertices_(space, "contact/vertices"),
      first_(space, "contact/first"), entries_(space, "contact/entries"), list_of_(space, "contact/list_of"),
      force_(space, "contact/force"), term_energy_(space, "contact/energy"), frozen_(space, "contact/frozen"),
      blocks_(space, "contact/blocks"), product_(space, "contact/product"),
      acting_(space, "contact/acting", 1), acting_sums_(space, "contact/acting_sums"),
      acting_on_host_(space, "contact/acting_on_host", 1)
{
}

void DeviceContactEnergy::take(const ContactEnergy& energy, int vertex_count)
{
    const StageScope stage("contact/to_device");
    const ContactEnergy::Touches& touches = energy.touches();
    terms_.upload(energy.terms());
    if (!has_terms())
        return;
    vertices_.upload(touches.vertices);
    first_.upload(touches.first);
    entries_.upload(touches.entries);
    force_.resize(terms_.size());
    term_energy_.resize(terms_.size());
    frozen_.resize(terms_.size());
    blocks_.resize(vertices_.size());
    product_.resize(vertices_.size());
    list_of_.resize(vertex_count);
    list_of_.fill_zero();
    parallel_for(space_, "contact/number_lists", vertices_.size(),
                 NumberList{vertices_.view(), list_of_.view()});
}

void DeviceContactEnergy::add_gradient(View<const Vec3> x, View<Vec3> gradient, View<double> energy)
{
    parallel_for(space_, "contact/evaluate", terms_.size(),
                 EvaluateContact{terms_.view(), x, force_.view(), term_energy_.view()});
    parallel_for(
        space_, "contact/gather", vertices_.size(),
        AddContact{touches(), vertices_.view(), force_.view(), term_energy_.view(), gradient, energy});
}

bool DeviceContactEnergy::activate(View<const Vec3> x)
{
    parallel_sum(space_, "contact/freeze", terms_.size(), 0,
                 FreezeAndCount{{terms_.view(), x, frozen_.view()}}, acting_.view(), acting_sums_);
    parallel_for(space_, "contact/blocks", vertices_.size(),
                 BoundList{touches(), frozen_.view(), blocks_.view()});
    acting_.download(acting_on_host_.view());
    space_.synchronise();
    return acting_on_host_[0] > 0;
}

void DeviceContactEnergy::multiply(View<const Vec3> p)
{
    parallel_for(space_, "contact/multiply", terms_.size(),
                 MultiplyContact{terms_.view(), frozen_.view(), p, force_.view()});
    parallel_for(space_, "contact/gather", vertices_.size(),
                 GatherList{touches(), force_.view(), product_.view()});
}

DeviceActiveSet::Frozen DeviceContactEnergy::frozen() const
{
    return {list_of_.view(), vertices_.view(), blocks_.view(), product_.view()};
}

} // namespace toile
