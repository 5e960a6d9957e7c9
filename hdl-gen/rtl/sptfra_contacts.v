// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Several bodies on one sensor, around the core for one: each frame is solved as that of one body; where several
// press, by the normal forces that are found, the forces are parted by their regions, and what those of each region
// cause is solved as a frame of its own, twice. A frame's forces are the sums of its bodies'.
//
// Frames go through the core one behind the other while those before them are looked at; none does while the bodies
// of one are solved. What is at work on the oldest frame: sptfra_regions, sptfra_parting, sptfra_parted_frames,
// sptfra_records.

`default_nettype none

module sptfra_contacts #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bodies that have a record, 2 to 8
    parameter CONTACTS = 4,
    // 1: the forces of all taxels go out, too; 0: the words before them alone
    parameter FIELD = 1,
    // Frames that have a place: 2, 4, 8 or 16
    parameter BANKS = 4,
    // Distances of neighbours in micrometres
    parameter STEP_X = 2000,
    parameter STEP_Y = 2000,
    parameter STEP_DIAGONAL = 2828,
    // Cycles until bodies are counted, and from there until the taxels are parted; checked in simulation, 0:
    // unchecked
    parameter integer EXPECTED_COUNTED = 0,
    parameter integer EXPECTED_PARTED = 0,
    // Power of two of a step of the coefficients in Pa/N
    parameter signed [9:0] COEFFICIENT_UNIT = 10'sd0,
    // 1: the sensor reads no tension
    parameter CLIPPED = 0,
    // Prefix of the ROM file names, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Coefficients by distance
    parameter PARTING_FILE = "",
    // See sptfra_records
    parameter [31:0] MIDDLE_X = 32'h3c1374bc,
    parameter [31:0] MIDDLE_Y = 32'h3c1374bc,
    parameter [31:0] CHANGE_SQUARED = 32'h3fc80000,
    parameter [31:0] NEARNESS = 32'h47742400,
    parameter [31:0] LIMIT = 32'h3d75c28f,
    parameter [31:0] SLIPS_FROM = 32'd0,
    parameter [31:0] SLIPS_STILL = 32'd0,
    parameter integer PROGRAM_LENGTH = 128,
    parameter RECORDS_FILE = "",
    parameter [16*(CONTACTS+1)-1:0] LATENCIES = {(16 * (CONTACTS + 1)){1'b0}}
) (
    input  wire clock,
    input  wire reset,
    // Frames as they come, for their time
    input  wire in_taken,
    input  wire in_last,
    // Frames in
    input  wire [31:0] s_tdata,
    input  wire s_tvalid,
    output wire s_tready,
    input  wire s_tlast,
    // To the core for one body, and its answers, which are never held
    output wire [31:0] core_s_tdata,
    output wire core_s_tvalid,
    input  wire core_s_tready,
    output wire core_s_tlast,
    input  wire [31:0] core_m_tdata,
    input  wire core_m_tvalid,
    output wire core_m_tready,
    input  wire core_m_tlast,
    // Forces out
    output wire [31:0] m_tdata,
    output wire m_tvalid,
    input  wire m_tready,
    output wire m_tlast
);

    generate
        if ((CONTACTS < 2) || (CONTACTS > 8)) begin : gen_check_contacts
            sptfra_error_contacts_must_be_2_to_8 invalid ();
        end
    endgenerate

    localparam TAXELS = COLUMNS * ROWS;
    localparam TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3;
    localparam FIELD_WIDTH = $clog2(3 * TAXELS);
    localparam BANK_WIDTH = $clog2(BANKS);
    // ---- What is done with the oldest frame
    wire there, next, weighs_largest, header_there, count_start, counted, parted, several, load_start;
    wire load_valid, loads, settled, hold, core_is_empty, with_bodies, is_second, part_start, part_done;
    wire is_contact, send_start, sent, adds, record_start, record_done, output_idle;
    wire [7:0] exponent;
    wire signed [9:0] unit;
    wire [3:0] header_address, header_index, kept, body, answering;
    wire [31:0] header_word;
    wire [FIELD_WIDTH-1:0] place;

    sptfra_contacts_turns #(
        .WORDS (3 * TAXELS)
    ) turns (
        .clock          (clock),
        .reset          (reset),
        .there          (there),
        .exponent       (exponent),
        .unit           (unit),
        .next           (next),
        .weighs_largest (weighs_largest),
        .header_address (header_address),
        .header_there   (header_there),
        .header_index   (header_index),
        .header_bodies  (header_word[7:0]),
        .is_contact     (is_contact),
        .count_start    (count_start),
        .counted        (counted),
        .parted         (parted),
        .kept           (kept),
        .several        (several),
        .load_start     (load_start),
        .place          (place),
        .load_valid     (load_valid),
        .loads          (loads),
        .settled        (settled),
        .hold           (hold),
        .core_is_empty  (core_is_empty),
        .with_bodies    (with_bodies),
        .is_second      (is_second),
        .part_start     (part_start),
        .part_done      (part_done),
        .send_start     (send_start),
        .body           (body),
        .sent           (sent),
        .answering      (answering),
        .answer_last    (core_m_tvalid && core_m_tlast),
        .adds           (adds),
        .record_start   (record_start),
        .record_done    (record_done),
        .output_idle    (output_idle)
    );

    // ---- Frames in and on
    wire [31:0] intake_tdata, stress;
    wire intake_tvalid, intake_tlast, frame_done, frames_advance;
    wire [TAXEL_WIDTH-1:0] frames_taxel;
    wire [BANK_WIDTH-1:0] oldest;

    sptfra_contacts_intake #(
        .TAXELS (TAXELS),
        .BANKS  (BANKS)
    ) intake (
        .clock        (clock),
        .reset        (reset),
        .s_tdata      (s_tdata),
        .s_tvalid     (s_tvalid),
        .s_tready     (s_tready),
        .s_tlast      (s_tlast),
        .free         (frame_done),
        .hold         (hold),
        .answered     (core_m_tvalid && core_m_tlast && !with_bodies),
        .drained      (core_is_empty),
        .m_tdata      (intake_tdata),
        .m_tvalid     (intake_tvalid),
        .m_tready     (core_s_tready && !with_bodies),
        .m_tlast      (intake_tlast),
        .read_enable  (frames_advance),
        .read_address ({oldest, frames_taxel}),
        .read_word    (stress)
    );

    wire [31:0] parted_tdata;
    wire parted_tvalid, parted_tlast;

    assign sent = parted_tvalid && core_s_tready && parted_tlast;
    assign core_s_tdata = with_bodies ? parted_tdata : intake_tdata;
    assign core_s_tvalid = with_bodies ? parted_tvalid : intake_tvalid;
    assign core_s_tlast = with_bodies ? parted_tlast : intake_tlast;

    // ---- Answers
    wire [3:0] word_index;
    wire in_field, output_advance;
    wire [31:0] presses, normal_word, field_word;
    wire [TAXEL_WIDTH-1:0] normal_address;
    wire [BANK_WIDTH+FIELD_WIDTH-1:0] output_field_address;

    assign core_m_tready = 1'b1;
    sptfra_contacts_answers #(
        .TAXELS (TAXELS),
        .BANKS  (BANKS)
    ) answers (
        .clock          (clock),
        .reset          (reset),
        .word_valid     (core_m_tvalid),
        .word           (core_m_tdata),
        .word_last      (core_m_tlast),
        .word_index     (word_index),
        .in_field       (in_field),
        .keeps          (!with_bodies),
        .there          (there),
        .next           (next),
        .oldest         (oldest),
        .exponent       (exponent),
        .largest        (presses),
        .header_address (header_address),
        .header_word    (header_word),
        .normal_address (normal_address),
        .normal_word    (normal_word),
        .field_enable   (loads || output_advance),
        .field_address  (loads ? {oldest, place} : output_field_address),
        .field_word     (field_word)
    );

    // ---- Normal forces as weights: their regions
    wire [7:0] bodies;
    wire [16*CONTACTS-1:0] taxels;
    wire [2:0] region;
    wire [TAXEL_WIDTH-1:0] list_address, list_taxel;
    wire [CONTACTS*(TAXEL_WIDTH+1)-1:0] sizes;

    sptfra_contacts_bodies #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .CONTACTS         (CONTACTS),
        .STEP_X           (STEP_X),
        .STEP_Y           (STEP_Y),
        .STEP_DIAGONAL    (STEP_DIAGONAL),
        .EXPECTED_COUNTED (EXPECTED_COUNTED),
        .EXPECTED_PARTED  (EXPECTED_PARTED)
    ) pressing (
        .clock          (clock),
        .reset          (reset),
        .unit           (unit),
        .weighs_largest (weighs_largest),
        .presses        (presses),
        .normal_address (normal_address),
        .normal_word    (normal_word),
        .start          (count_start),
        .counted        (counted),
        .bodies         (bodies),
        .kept           (kept),
        .taxels         (taxels),
        .parted         (parted),
        .region_address (frames_taxel),
        .region         (region),
        .list_address   (list_address),
        .list_taxel     (list_taxel),
        .sizes          (sizes)
    );

    // ---- Forces: those of one body, or of several, added up; what they cause, and the frames of the bodies
    wire output_reads, saturated;
    wire [TAXEL_WIDTH-1:0] output_taxel;
    wire [80:0] forces;
    wire of_body = core_m_tvalid && with_bodies;

    sptfra_contacts_parts #(
        .COLUMNS          (COLUMNS),
        .ROWS             (ROWS),
        .CONTACTS         (CONTACTS),
        .COEFFICIENT_UNIT (COEFFICIENT_UNIT),
        .CLIPPED          (CLIPPED),
        .ROM_DIR          (ROM_DIR),
        .FILE             (PARTING_FILE)
    ) parts (
        .clock          (clock),
        .reset          (reset),
        .unit           (unit),
        .begins         (load_start),
        .saturated      (saturated),
        .field_begins   (loads ? load_start : of_body && !in_field),
        .field_valid    (load_valid || (of_body && in_field)),
        .field_word     (with_bodies ? core_m_tdata : field_word),
        .adds           (adds),
        .bank           (with_bodies && !is_second),
        .settled        (settled),
        .output_reads   (output_reads),
        .output_advance (output_advance),
        .output_taxel   (output_taxel),
        .forces         (forces),
        .part_start     (part_start),
        .part_bank      (is_second),
        .part_done      (part_done),
        .kept           (kept),
        .sizes          (sizes),
        .list_address   (list_address),
        .list_taxel     (list_taxel),
        .send_start     (send_start),
        .body           (body),
        .advance        (frames_advance),
        .taxel          (frames_taxel),
        .region         (region),
        .stress         (stress),
        .word           (parted_tdata),
        .word_last      (parted_tlast),
        .word_valid     (parted_tvalid),
        .word_ready     (core_s_tready)
    );

    // ---- The words before the field, and out; a contact of which nothing presses is a body that touches no taxel
    wire is_flat = is_contact && (kept == 4'd0);
    sptfra_contacts_output #(
        .TAXELS            (TAXELS),
        .CONTACTS          (CONTACTS),
        .FIELD             (FIELD),
        .BANKS             (BANKS),
        .ROM_DIR           (ROM_DIR),
        .MIDDLE_X          (MIDDLE_X),
        .MIDDLE_Y          (MIDDLE_Y),
        .CHANGE_SQUARED    (CHANGE_SQUARED),
        .NEARNESS          (NEARNESS),
        .LIMIT             (LIMIT),
        .SLIPS_FROM        (SLIPS_FROM),
        .SLIPS_STILL       (SLIPS_STILL),
        .PROGRAM_LENGTH    (PROGRAM_LENGTH),
        .RECORDS_FILE      (RECORDS_FILE),
        .LATENCIES         (LATENCIES)
    ) words (
        .clock         (clock),
        .reset         (reset),
        .in_taken      (in_taken),
        .in_last       (in_last),
        .header_write  (header_there || (of_body && !in_field)),
        .header_body   (with_bodies ? answering : 4'd8),
        .header_before (with_bodies && !is_second),
        .header_index  (with_bodies ? word_index : header_index),
        .header_word   (with_bodies ? core_m_tdata : header_word),
        .record_start  (record_start),
        .kept          (is_flat ? 4'd1 : kept),
        .bodies        (is_flat ? 8'd1 : bodies),
        .taxels        (taxels),
        .saturated     (several && saturated),
        .record_done   (record_done),
        .start         (next),
        .idle          (output_idle),
        .several       (several),
        .unit          (unit),
        .bank          (oldest),
        .done          (frame_done),
        .advance       (output_advance),
        .field_address (output_field_address),
        .field_word    (field_word),
        .taxel         (output_taxel),
        .reads_forces  (output_reads),
        .forces        (forces),
        .m_tdata       (m_tdata),
        .m_tlast       (m_tlast),
        .m_tvalid      (m_tvalid),
        .m_tready      (m_tready)
    );

endmodule

`default_nettype wire
