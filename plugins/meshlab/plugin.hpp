// SPDX-License-Identifier: GPL-3.0-or-later
/// The filters as MeshLab sees them: names, descriptions, what they need and change, and how they are run.

#ifndef DECIMESH_MESHLAB_PLUGIN_HPP
#define DECIMESH_MESHLAB_PLUGIN_HPP

#include <string>

#include <common/interfaces.h>

/// Four filters. One that fails, or that MeshLab's callback ends by answering false, changes nothing; why it failed is
/// its message and in the log, for `meshlabserver` shows the log alone.
class DecimeshPlugin : public QObject, public MeshFilterInterface {
    Q_OBJECT
    MESHLAB_PLUGIN_IID_EXPORTER(MESH_FILTER_INTERFACE_IID)
    Q_INTERFACES(MeshFilterInterface)

public:
    enum Filter : FilterIDType { simplify, choose, levels, deviation };

    DecimeshPlugin();

    QString pluginName() const override;
    using MeshFilterInterface::filterName;
    QString filterName(FilterIDType filter) const override;
    using MeshFilterInterface::filterInfo;
    QString filterInfo(FilterIDType filter) const override;
    FilterClass getClass(QAction *action) override;
    FILTER_ARITY filterArity(QAction *action) const override;
    int getPreConditions(QAction *action) const override;
    int postCondition(QAction *action) const override;
    using MeshFilterInterface::initParameterSet;
    void initParameterSet(QAction *action, MeshDocument &document, RichParameterList &parameters) override;
    bool applyFilter(QAction *action, MeshDocument &document, const RichParameterList &parameters,
                     vcg::CallBackPos *callback) override;

private:
    void apply_simplify(MeshModel &layer, const RichParameterList &parameters, vcg::CallBackPos *callback);
    void apply_choose(MeshModel &layer, const RichParameterList &parameters, vcg::CallBackPos *callback);
    void apply_levels(MeshDocument &document, const RichParameterList &parameters, vcg::CallBackPos *callback);
    void apply_deviation(MeshModel &layer, const RichParameterList &parameters, vcg::CallBackPos *callback);
    void log(const std::string &line);
};

#endif
